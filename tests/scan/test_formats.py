"""Readers of single formats: what they take from the file, and what they refuse."""

import struct
import subprocess
import sys
import zipfile
from collections import Counter

import numpy as np
import pytest
from scan_writers import write
from stated import read_scan

from fractalcontact.core.errors import InputError
from fractalcontact.scan import formats, raw, read
from fractalcontact.scan.format import Format
from fractalcontact.scan.options import ScanOptions
from fractalcontact.scan.raw import IncompleteSidecar
from fractalcontact.scan.readers import instruments
from fractalcontact.study.sidecar import sidecar_of_matrix

DX, DY = 0.1, 0.25
MATRIX = {"unit": "mm", "spacing": [DX, DY]}


def surface(shape=(9, 14)):
    """Heights in mm without symmetry; one cell is missing."""
    heights = np.random.default_rng(3).uniform(-0.2, 0.2, shape)
    heights[1, 2] = np.nan
    return heights


# --- X3P ---------------------------------------------------------------------------------------


def x3p(path, file):
    file.save(path)
    return path


def test_a_layer_of_an_x3p_file_is_named(tmp_path):
    import x3pio

    layers = np.stack([surface(), 2 * surface()]) * 1e-3
    path = x3p(tmp_path / "rock.x3p", x3pio.Surface.from_array(layers, x_scale=1e-4, y_scale=1e-4))
    with pytest.raises(InputError, match=r"'variable: NAME'; it has layer 1, layer 2"):
        read_scan(path)
    heights = read_scan(path, {"variable": "layer 2"})
    np.testing.assert_allclose(heights, 2 * surface(), rtol=1e-12)
    assert heights.attrs["notes"] == "layer 2 of 2"


def test_an_x3p_profile_is_refused(tmp_path):
    import x3pio

    path = x3p(tmp_path / "rock.x3p", x3pio.Profile.from_array(np.arange(20.0), x_scale=1e-6))
    with pytest.raises(InputError, match="a profile"):
        read_scan(path)


def test_an_irregular_x3p_grid_is_read_as_points_in_global_coordinates(tmp_path):
    import x3pio

    y, x = np.indices((12, 15)) * 1e-4
    grid = np.stack([x, y, np.random.default_rng(0).uniform(0, 1e-4, x.shape)], axis=-1)
    shifted = x3pio.Surface.from_points(
        grid,
        placement=x3pio.Placement(offset=[2e-3, 0, 5e-3]),
        coordinate_system=x3pio.CoordinateSystem.VIEW,
    )
    heights = read_scan(x3p(tmp_path / "rock.x3p", shifted))
    np.testing.assert_allclose(heights, 1e3 * grid[..., 2] + 5, rtol=1e-12)
    assert float(heights.x[0]) == pytest.approx(2.0)


def test_a_regular_x3p_grid_has_the_heights_of_its_points(tmp_path):
    """Its placement raises it, as it raises the points that the same file would be as a cloud."""
    import x3pio

    grid = x3pio.Surface.from_array(
        surface() * 1e-3,
        x_scale=1e-4,
        y_scale=2e-4,
        placement=x3pio.Placement(offset=[0, 0, 5e-3]),
        coordinate_system=x3pio.CoordinateSystem.VIEW,
    )
    points = 1e3 * grid.layers[0].points()
    heights = read_scan(x3p(tmp_path / "rock.x3p", grid))
    np.testing.assert_allclose(heights, points[..., 2], rtol=1e-12)
    np.testing.assert_allclose(heights, surface() + 5, rtol=1e-12)


def rewritten(path, name, change):
    """The same archive with one member changed."""
    with zipfile.ZipFile(path) as archive:
        members = {member: archive.read(member) for member in archive.namelist()}
    members[name] = change(members[name])
    with zipfile.ZipFile(path, "w") as archive:
        for member, content in members.items():
            archive.writestr(member, content)
    return path


@pytest.mark.parametrize(
    ("member", "change"),
    [
        ("bindata/data.bin", lambda content: content[:-8] + b"\0" * 8),
        ("main.xml", lambda content: content.replace(b"0.0001", b"0.0002", 1)),
    ],
)
def test_x3p_content_that_does_not_match_its_checksum_is_warned_of(tmp_path, member, change):
    path = tmp_path / "rock.x3p"
    write(path, surface(), DX, DX)
    assert read_scan(path).attrs["warnings"] == ""
    rewritten(path, member, change)
    heights = read_scan(path)
    assert "checksum of" in heights.attrs["warnings"]
    assert "compare it with its source" in heights.attrs["warnings"]
    if member == "main.xml":
        np.testing.assert_allclose(heights, surface(), rtol=1e-12)
        assert 2e-4 / heights.attrs["spacing_x"] == pytest.approx(1e-3)  # as the file says
    else:
        assert (heights.values == surface()).mean() > 0.8  # all but the zeros


def old_x3p(path):
    """As R's x3ptools writes: root element of the first edition, its own checksum, origin NW."""
    import hashlib

    write(path, surface(), DX, DY)
    with zipfile.ZipFile(path) as archive:
        index = archive.read("main.xml").decode()
    start, end = index.index("<p:ISO5436_2"), index.index(">", index.index("<p:ISO5436_2"))
    index = index[:start] + "<ISO5436" + index[end:].replace("</p:ISO5436_2>", "</ISO5436>")
    index = index.replace("</Axes>", "<Origin>NW</Origin></Axes>")
    rewritten(path, "main.xml", lambda _: index.encode())
    digest = hashlib.md5(index.encode()).hexdigest()
    return rewritten(path, "md5checksum.hex", lambda _: f"{digest} *main.xml".encode())


def test_x3p_of_the_first_edition_from_the_north_west(tmp_path):
    path = old_x3p(tmp_path / "rock.x3p")
    np.testing.assert_allclose(read_scan(path), surface()[::-1], rtol=1e-12)
    heights = read_scan(path, {"first_row": "bottom"})
    np.testing.assert_allclose(heights, surface(), rtol=1e-12)
    assert heights.attrs["overrides"] == "first_row bottom from the sidecar, the file says top"
    rewritten(path, "main.xml", lambda content: content.replace(b"0.0001", b"0.0002", 1))
    assert "checksum of main.xml does not match" in read_scan(path).attrs["warnings"]


# --- MATLAB's objects --------------------------------------------------------------------------


def element(kind, content):
    """A data element of a MATLAB file of version 5: type, length, content to whole eight bytes."""
    return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)


def string_object(name, system=b"MCOS", class_name=b"string"):
    """An opaque object, as MATLAB saves a string: no size, and a reference in place of content."""
    reference = np.array([0xDD000000, 2, 1, 1, 1, 1], "<u4")
    flags = [element(6, struct.pack("<II", number, 0)) for number in (17, 13)]
    sizes = element(5, struct.pack("<ii", len(reference), 1))
    inner = element(14, flags[1] + sizes + element(1, b"") + element(6, reference.tobytes()))
    names = b"".join(element(1, text) for text in (name, system, class_name))
    return element(14, flags[0] + names + inner)


@pytest.mark.parametrize("class_name", [b"string", b"datetime", b"table"])
@pytest.mark.parametrize("first", [False, True])
def test_a_matlab_file_that_also_holds_an_object_is_read(tmp_path, first, class_name):
    path = tmp_path / "rock.mat"
    options = write(path, surface(), DX, DY)
    content, thing = path.read_bytes(), string_object(b"operator", class_name=class_name)
    path.write_bytes(
        content[:128] + (thing if first else b"") + content[128:] + thing * (not first)
    )
    np.testing.assert_array_equal(read_scan(path, options), surface())
    path.write_bytes(content[:128] + thing)
    with pytest.raises(InputError, match=r"rock\.mat: holds no 2-D array of real numbers"):
        read_scan(path, options)


# --- netCDF ------------------------------------------------------------------------------------


def netcdf(path, heights, x=None, y=None, dims=("y", "x"), units=("mm", "mm"), z_units="mm"):
    """A file as climate and lab software writes it; without coordinates if x is None."""
    import netCDF4

    with netCDF4.Dataset(path, "w") as file:
        for name, length in zip(dims, heights.shape, strict=True):
            file.createDimension(name, length)
        for name, values, unit in (("x", x, units[0]), ("y", y, units[1])):
            if values is not None:
                file.createVariable(name, "f4", (name,))[:] = values
                if unit:
                    file[name].units = unit
        file.createVariable("z", "f8", dims, fill_value=np.nan)[:] = heights
        if z_units:
            file["z"].units = z_units
    return path


def coordinates(shape=(9, 14)):
    return DX * np.arange(shape[1]) + 5, DY * np.arange(shape[0]) - 3


def test_descending_and_swapped_netcdf_axes_are_turned(tmp_path):
    x, y = coordinates()
    variants = {
        "plain": (surface(), x, y, ("y", "x")),
        "y descends": (surface()[::-1], x, y[::-1], ("y", "x")),
        "x descends": (surface()[:, ::-1], x[::-1], y, ("y", "x")),
        "x first": (surface().T, x, y, ("x", "y")),
    }
    for name, (heights, x_values, y_values, dims) in variants.items():
        read = read_scan(netcdf(tmp_path / f"{name}.nc", heights, x_values, y_values, dims))
        np.testing.assert_array_equal(read, surface(), err_msg=name)
        assert read.attrs["spacing_x"] == pytest.approx(DX, rel=1e-5)
        assert read.attrs["spacing_y"] == pytest.approx(DY, rel=1e-5)


def test_each_netcdf_axis_has_its_own_unit(tmp_path):
    x, y = coordinates()
    path = netcdf(
        tmp_path / "rock.nc", surface() * 1e3, x, y * 1e3, units=("mm", "um"), z_units="um"
    )
    read = read_scan(path)
    np.testing.assert_allclose(read, surface(), rtol=1e-12)
    assert read.attrs["spacing_y"] == pytest.approx(DY, rel=1e-5)
    assert read.attrs["file_unit"] == "x, y mm; z um"


@pytest.mark.parametrize("units", [(None, None), ("degrees_east", "degrees_north")])
def test_netcdf_coordinates_that_are_no_lengths_need_the_sidecar(tmp_path, units):
    path = netcdf(tmp_path / "rock.nc", surface(), *coordinates(), units=units, z_units=None)
    with pytest.raises(IncompleteSidecar, match="has no sidecar"):
        read.read_scan(path)
    heights = read_scan(path, MATRIX)
    np.testing.assert_array_equal(heights, surface())
    assert heights.attrs["spacing_y"] == DY


def test_an_irregular_netcdf_coordinate_is_refused(tmp_path):
    x, y = coordinates()
    path = netcdf(tmp_path / "rock.nc", surface(), x**1.5, y)
    with pytest.raises(InputError, match=r"coordinate 'x' is not equidistant"):
        read_scan(path)


def test_one_of_several_netcdf_variables_is_named(tmp_path):
    import netCDF4

    path = netcdf(tmp_path / "rock.nc", surface(), *coordinates())
    with netCDF4.Dataset(path, "a") as file:
        inner = file.createGroup("raw")
        inner.createVariable("z", "f8", ("y", "x"))[:] = surface() + 1
        inner["z"].units = "mm"
    with pytest.raises(InputError, match="it has raw/z, z"):
        read_scan(path)
    np.testing.assert_array_equal(read_scan(path, {"variable": "raw/z"}), surface() + 1)


# --- HDF5 and MATLAB ---------------------------------------------------------------------------


def hdf5(path, **datasets):
    import h5py

    with h5py.File(path, "w") as file:
        for name, values in datasets.items():
            file[name] = values
    return path


def test_of_several_hdf5_datasets_one_is_named(tmp_path):
    path = hdf5(tmp_path / "rock.h5", z=surface(), raw=surface() + 1)
    keys = write(tmp_path / "other.npy", surface(), DX, DY)
    with pytest.raises(IncompleteSidecar, match="lacks variable") as error:
        read.read_scan(path, keys)
    assert "variable: z" in error.value.draft
    assert "raw of 9 x 14" in error.value.draft
    np.testing.assert_array_equal(read.read_scan(path, keys | {"variable": "raw"}), surface() + 1)


def test_hdf5_data_in_other_files_is_never_opened(tmp_path):
    import h5py

    (tmp_path / "secret.bin").write_bytes(surface().tobytes())
    hdf5(tmp_path / "other.h5", z=surface())
    path = tmp_path / "rock.h5"
    with h5py.File(path, "w") as file:
        file.create_dataset("z", (9, 14), "f8", external=str(tmp_path / "secret.bin"))
    with pytest.raises(InputError, match="lies in another file"):
        read_scan(path, MATRIX)
    with h5py.File(path, "w") as file:
        layout = h5py.VirtualLayout((9, 14), "f8")
        layout[:] = h5py.VirtualSource(tmp_path / "other.h5", "z", (9, 14))
        file.create_virtual_dataset("z", layout)
    with pytest.raises(InputError, match="lies in another file"):
        read_scan(path, MATRIX)
    with h5py.File(path, "w") as file:
        file["z"] = h5py.ExternalLink(str(tmp_path / "other.h5"), "z")
    with pytest.raises(InputError, match="no 2-D array"):
        read_scan(path, MATRIX)


@pytest.mark.parametrize("extension", ["h5", "nc"])
def test_a_header_that_promises_too_much_is_refused_unread(tmp_path, extension):
    """Nothing is stored of these 8 TB, so the file is tiny."""
    import h5py

    path = tmp_path / f"rock.{extension}"
    with h5py.File(path, "w") as file:
        file.create_dataset("z", (10**6, 10**6), "f8", chunks=(100, 100), compression="gzip")
    assert path.stat().st_size < 10_000
    with pytest.raises(InputError, match="GiB to read"):
        read_scan(path, write(tmp_path / "other.npy", surface(), DX, DY))


def test_only_plain_matrices_of_mat_files_are_opened(tmp_path):
    from scipy.io import savemat

    path = tmp_path / "rock.mat"
    cell = np.full((2, 2), "rock", dtype=object)
    others = {
        "scalar": 3.0,
        "row": np.arange(4.0),
        "text": "rock",
        "cell": cell,
        "struct": {"a": 1},
    }
    savemat(path, {"z": surface(), **others})
    np.testing.assert_array_equal(read_scan(path, MATRIX), surface())
    for name in others:
        with pytest.raises(InputError, match=rf"'variable' is '{name}'.*it has z"):
            read_scan(path, MATRIX | {"variable": name})
    savemat(path, {"z": surface() * 1j})
    with pytest.raises(InputError, match="complex128; heights are real"):
        read_scan(path, MATRIX)
    savemat(path, others)
    with pytest.raises(InputError, match="no 2-D array"):
        read_scan(path, MATRIX)


# --- Surfer --------------------------------------------------------------------------------------


def surfer(path, heights, z_range):
    """A text grid of Surfer."""
    values = np.where(np.isnan(heights), 1.70141e38, heights)
    lines = ["DSAA", "14 9", "0 13", "0 8", z_range]
    lines += [" ".join(f"{value:.6e}" for value in row) for row in values]
    path.write_text("\n".join(lines) + "\n")
    return path


SURFER = {"kind": "face", "unit": "mm", "heights": "up"}


@pytest.mark.parametrize("end", ["", "\n"])
def test_a_last_height_outside_the_range_of_its_header_is_cut_off(tmp_path, end):
    heights = surface()
    heights[-1, -1] = 1.234567e-3
    path = surfer(tmp_path / "rock.grd", heights, "-0.2 0.2")
    whole = path.read_text()
    np.testing.assert_allclose(read.read_scan(path, SURFER), heights, rtol=1e-6)
    assert whole.rstrip().endswith("e-03")
    path.write_text(whole.rstrip()[:-4] + end)
    reason = "its last one is 1.23457: the file is cut off" if end else "breaks off within a number"
    with pytest.raises(InputError, match=reason):
        read.read_scan(path, SURFER)


def test_a_range_that_is_not_that_of_the_heights_is_noted(tmp_path):
    """Scripts write 0 and 1 there."""
    path = surfer(tmp_path / "rock.grd", surface(), "0 0.1")
    heights = read.read_scan(path, SURFER)
    np.testing.assert_allclose(heights, surface(), rtol=1e-6)
    assert (
        "states heights from 0 to 0.1, the file holds heights from -0.1" in heights.attrs["notes"]
    )
    assert heights.attrs["warnings"] == ""


# --- TIFF --------------------------------------------------------------------------------------


def tiff(path, image, **options):
    import tifffile

    tifffile.imwrite(path, image, **options)
    return path


def test_imagej_states_the_size_of_a_pixel(tmp_path):
    path = tmp_path / "rock.tif"
    pixels = (1 / (DX * 1e3), 1 / (DY * 1e3))  # a um
    image = surface()[::-1].astype(np.float32)
    tiff(path, image, imagej=True, resolution=pixels, metadata={"unit": "um"})
    heights = read_scan(path, {"unit_z": "mm", "first_row": "top"})
    np.testing.assert_allclose(heights, surface(), atol=1e-7)
    assert heights.attrs["spacing_x"] == pytest.approx(DX, rel=1e-6)
    assert heights.attrs["spacing_y"] == pytest.approx(DY, rel=1e-6)


def test_sixteen_bits_and_the_number_for_missing_cells(tmp_path):
    steps = np.where(np.isnan(surface()), -999, np.round(np.nan_to_num(surface()) * 1e4))
    path = tmp_path / "rock.tiff"
    tiff(path, steps.astype(np.int16), extratags=[(42113, "s", 0, "-999", True)])
    heights = read_scan(path, {"unit_z": "0.1 um", "spacing": "0.1 mm", "first_row": "bottom"})
    np.testing.assert_allclose(heights, np.round(surface(), 4), atol=1e-12)


def test_pictures_are_no_heights(tmp_path):
    path = tmp_path / "rock.tif"
    grey = (np.nan_to_num(surface()) * 500 + 120).astype(np.uint8)
    tiff(path, np.stack([grey] * 3, axis=-1), photometric="rgb")
    with pytest.raises(InputError, match="a colour image"):
        read_scan(path, MATRIX)
    tiff(path, grey)
    with pytest.raises(InputError, match=r"8 bits.*'unit_z: um'"):
        read_scan(path, MATRIX)
    heights = read_scan(path, {"unit_z": "um", "spacing": "0.1 mm", "first_row": "top"})
    np.testing.assert_allclose(heights, grey[::-1] * 1e-3)
    assert "256 steps" in heights.attrs["notes"]


def test_a_page_of_a_tiff_is_named(tmp_path):
    pages = np.stack([surface(), surface() + 1]).astype(np.float32)
    path = tiff(tmp_path / "rock.tif", pages, photometric="minisblack")
    with pytest.raises(IncompleteSidecar, match="lacks variable"):
        read.read_scan(path, write(tmp_path / "other.tif", surface(), DX, DY))
    heights = read_scan(path, MATRIX | {"variable": "page 2", "first_row": "bottom"})
    np.testing.assert_allclose(heights, surface() + 1, atol=1e-7)


def libtiff(path, image, compression, predictor):
    """A file of libtiff, which GDAL and ArcGIS use, in strips of 17 rows."""
    from PIL import Image

    picture = Image.fromarray(image)
    picture.save(path, compression=compression, tiffinfo={317: predictor, 278: 17})
    return path


@pytest.mark.parametrize("compression", ["tiff_lzw", "tiff_adobe_deflate"])
@pytest.mark.parametrize(
    ("kind", "predictor"), [(np.uint16, 1), (np.uint16, 2), (np.float32, 1), (np.float32, 3)]
)
def test_compressions_and_predictors_of_libtiff(tmp_path, compression, kind, predictor):
    """Cells in single steps and of one value everywhere: codes of all widths, and full tables."""
    generator = np.random.default_rng(7)
    steps = np.cumsum(generator.integers(-3, 4, (90, 140)), axis=1) + 30_000
    steps[40:60, 20:90] = 31_000
    image = (steps * (1 if kind is np.uint16 else 0.37)).astype(kind)
    path = libtiff(tmp_path / "rock.tif", image, compression, predictor)
    stated = {"unit_z": "um", "spacing": "0.1 mm", "first_row": "top", "missing": "none"}
    heights = read_scan(path, stated)
    np.testing.assert_allclose(heights, image[::-1].astype(float) * 1e-3, rtol=1e-12)


@pytest.mark.parametrize("byteorder", "<>")
def test_predictor_3_of_either_byte_order(tmp_path, byteorder):
    """Bytes of all numbers stand highest first, whatever the order of the file is."""
    image = np.random.default_rng(5).normal(0, 1, (12, 15)).astype(np.float32)
    planes = image.astype(">f4").view(np.uint8).reshape(12, 15, 4).swapaxes(1, 2).reshape(12, 60)
    stored = np.diff(planes, axis=1, prepend=np.uint8(0)).view(f"{byteorder}f4")
    own_tag = [(65000, "H", 1, 3, True)]
    keys = {"byteorder": byteorder, "compression": "zlib", "extratags": own_tag}
    path = tiff(tmp_path / "rock.tif", stored, **keys)
    tags = [struct.pack(f"{byteorder}HHI", tag, 3, 1) for tag in (65000, 317)]
    path.write_bytes(path.read_bytes().replace(*tags))
    heights = read_scan(path, {"unit": "mm", "spacing": 1, "first_row": "top"})
    np.testing.assert_array_equal(heights, image[::-1])


def test_a_compression_without_decoder_is_refused_with_a_remedy(tmp_path):
    path = tiff(tmp_path / "rock.tif", surface().astype(np.float32))
    damaged = bytearray(path.read_bytes())
    place = damaged.index(struct.pack("<HHI", 259, 3, 1))
    damaged[place + 8 : place + 10] = struct.pack("<H", 34887)  # LERC
    path.write_bytes(damaged)
    with pytest.raises(InputError, match=r"compression LERC .*gdal_translate -co COMPRESS=DEFLATE"):
        read_scan(path, MATRIX | {"first_row": "top"})


@pytest.mark.parametrize(
    ("first", "reason"),
    [
        (b"\0\1", "do not begin as TIFF 6.0 says"),  # as programs before 1993 wrote
        (bytes([0b10000000, 0b01001011, 0]), "LZW code 300 is not defined"),  # 256, 300, ...
        (bytes([0b10000000, 0b01000000, 0b01000000]), "corrupted strip"),  # 256, 257: no cells
    ],
)
def test_damaged_lzw_codes_are_refused(tmp_path, first, reason):
    image = np.random.default_rng(1).integers(0, 60_000, (40, 60)).astype(np.uint16)
    path = libtiff(tmp_path / "rock.tif", image, "tiff_lzw", 2)
    content = bytearray(path.read_bytes())
    content[8 : 8 + len(first)] = first
    path.write_bytes(content)
    with pytest.raises(InputError, match=reason):
        read_scan(path, {"unit_z": "um", "spacing": "0.1 mm", "first_row": "top"})


# --- Gwyddion ----------------------------------------------------------------------------------


def test_a_gwyddion_file_says_what_is_masked_and_which_channel(tmp_path):
    path = tmp_path / "rock.gwy"
    write(path, surface(), DX, DY)
    heights = read_scan(path, {"variable": "Topography"})
    assert heights.attrs["file_unit"] == "m"
    assert "under the mask" in heights.attrs["notes"]
    with pytest.raises(InputError, match="no channel 'phase'"):
        read_scan(path, {"variable": "phase"})


# --- sizes that cannot be ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"spacing": "20 m"}, r"not plausible.*'spacing: 0\.5 um'"),
        ({"spacing": "1e-9 mm"}, r"less than an atom.*'spacing: 0\.5 um'"),
        ({"spacing": ["0.1 mm", "11 mm"]}, r"more than 100 times.*'spacing: \[0\.1 mm, 0\.2 mm\]'"),
        ({"spacing": "1 um"}, r"relief of 0\.3846 mm above .* is not plausible"),
        ({"unit": "m", "spacing": "0.1 mm"}, "more than the field is wide, is not plausible"),
        ({"spacing": "0 mm"}, "above zero"),
    ],
)
def test_sizes_no_scan_has_are_refused(tmp_path, options, message):
    path = tmp_path / "rock.npy"
    np.save(path, surface())
    with pytest.raises(InputError, match=rf"rock\.npy.*{message}"):
        read_scan(path, {"unit": "mm"} | options)


@pytest.mark.parametrize("step", [0.0, -1.0, np.inf])
def test_a_spacing_in_the_file_that_is_no_length_is_refused_until_the_sidecar_says(tmp_path, step):
    path = sdf(tmp_path / "rock.sdf", surface(), step, 1e-4)
    with pytest.raises(InputError, match=r"rock\.sdf: cells of .* not plausible.*'spacing: 0"):
        read_scan(path)
    heights = read_scan(path, {"spacing": "0.1 mm"})
    np.testing.assert_allclose(heights, surface(), rtol=1e-12)


def sdf(path, heights, dx, dy):
    """A binary ISO 25178-71 file: the header states the spacing in m."""
    rows, columns = heights.shape
    header = struct.pack(
        "<8s10s12s12sHHddddBBB",
        *(b"bISO-1.0", b"test", b"", b"", columns, rows, dx, dy, 1e-3, 0.0, 0, 7, 0),
    )
    path.write_bytes(header + heights.astype("<f8").tobytes())
    return path


def test_a_sidecar_that_overrides_an_instrument_is_recorded(tmp_path):
    path = sdf(tmp_path / "rock.sdf", surface(), DX * 1e-3, DY * 1e-3)
    heights = read_scan(path)
    np.testing.assert_allclose(heights, surface(), rtol=1e-12)
    assert heights.attrs["overrides"] == ""
    assert heights.attrs["spacing_y"] == pytest.approx(DY)
    heights = read_scan(path, {"unit_z": "nm", "spacing": "0.5 mm"})
    np.testing.assert_allclose(heights, surface() * 1e-3, rtol=1e-12)
    assert heights.attrs["overrides"] == (
        "unit_z nm from the sidecar, the file says µm; "
        "spacing 0.5 x 0.5 mm from the sidecar, the file says 0.1 x 0.25 mm"
    )


def test_units_that_are_no_units_of_length_state_nothing():
    assert [raw.stated_unit(text) for text in ("um", "µm", "Å", "m ")] == ["um", "µm", "Å", "m"]
    for text in ("", None, "V", "1", "degrees_east", "m**9**9", "9**9**9", "mm; rm", "\0"):
        assert raw.stated_unit(text) is None


def test_formats_of_our_own_are_not_read_by_surfacetopography():
    extensions = instruments.instrument_formats()
    assert not {"x3p", "npy", "npz", "nc", "h5", "mat", "asc", "xyz", "gwy"} & set(extensions)
    assert {f".{ending}" for ending in extensions} == set(instruments.FORMAT.endings)


# --- the registry -------------------------------------------------------------------------------


def test_each_format_declares_endings_that_it_need_not_share_unseen():
    """Where two formats share an ending, all but one look at the content."""
    endings = Counter()
    for name, declared in formats.FORMATS.items():
        assert declared.endings, name
        assert all(end == end.lower() and end.startswith(".") for end in declared.endings)
        if declared.takes is None:
            endings.update(declared.endings)
    assert {end for end, count in endings.items() if count > 1} == set()
    assert set(endings) <= set(formats.known_extensions())


def test_a_format_is_known_once_it_is_declared(tmp_path, monkeypatch):
    def read(path, options):
        return raw.RawScan(np.full((9, 9), float(path.read_text())), "matrix", "dummy")

    own = Format(read, endings=(".dummy",), takes=lambda path: path.read_text() != "none")
    monkeypatch.setitem(formats.FORMATS, "dummy", own)
    assert ".dummy" in formats.known_extensions()
    assert formats.likely_formats(".dummy") == [own]
    path = tmp_path / "rock.DUMMY"
    path.write_text("3")
    assert formats.read_raw(path, ScanOptions()).values[0, 0] == 3
    path.write_text("none")
    with pytest.raises(InputError, match=r"rock\.DUMMY: unknown extension '\.dummy'; known: "):
        formats.read_raw(path, ScanOptions())
    refusing = Format(read, endings=(".dummy",), takes=own.takes, refusal="holds none")
    monkeypatch.setitem(formats.FORMATS, "dummy", refusing)
    with pytest.raises(InputError, match=r"rock\.DUMMY: holds none$"):
        formats.read_raw(path, ScanOptions())


def test_a_content_that_one_format_refuses_is_offered_to_the_others(tmp_path, monkeypatch):
    """A text file's ending on an instrument's binary file, and the other way round."""
    path = tmp_path / "rock.dat"
    path.write_bytes(b"\0\1\2\3" * 40)
    with pytest.raises(InputError, match=r"rock\.dat: damaged, or not what its extension says"):
        formats.read_raw(path, ScanOptions())
    for name in ("rock.csv", "rock.xyz"):
        path = path.rename(tmp_path / name)
        with pytest.raises(InputError, match="not a text file; export it again as text"):
            formats.read_raw(path, ScanOptions())


def test_nothing_but_the_reader_process_imports_the_readers(tmp_path):
    """They open untrusted input; and to read the workflow, or a scan, must not wait for them."""
    code = (
        "import sys, numpy\n"
        "from fractalcontact.scan.read import read_matrix\n"
        "from fractalcontact.study.scan_files import list_scans\n"
        "numpy.save('rock.npy', numpy.arange(99.0).reshape(9, 11))\n"
        "assert list(list_scans('.')[0]) == ['rock']\n"
        f"read_matrix('rock.npy', {sidecar_of_matrix(1.0)})\n"
        "print([name for name in sys.modules if 'scan.readers' in name or 'scan.formats' in name])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert (done.stdout, done.stderr) == ("[]\n", "")


# --- order of rows -----------------------------------------------------------------------------


def write_sdf(path, z):
    """ISO 25178-71 in text, heights and spacing in m."""
    ny, nx = z.shape
    head = ["aISO-1.0", "ManufacID = test", "CreateDate = 010120200000", "ModDate = 010120200000"]
    head += [f"NumPoints = {nx}", f"NumProfiles = {ny}", "Xscale = 1E-4", "Yscale = 2E-4"]
    head += ["Zscale = 1E-6", "Zresolution = -1", "Compression = 0", "DataType = 7"]
    head += ["CheckType = 0", "*"]
    rows = [" ".join(f"{v * 1e3:.6f}" for v in row) for row in z]
    path.write_text("\r\n".join([*head, *rows, "*", ""]))


def write_bcrf(path, z):
    """SPIP's floating point format, heights in nm."""
    ny, nx = z.shape
    head = f"fileformat = bcrf\nxpixels = {nx}\nypixels = {ny}\nxlength = {nx * 1e5}\n"
    head += f"ylength = {ny * 2e5}\nintelmode = 1\nbit2nm = 1\nxunit = nm\nyunit = nm\nzunit = nm\n"
    path.write_bytes(head.encode().ljust(2048) + (z * 1e6).astype("<f4").tobytes())


@pytest.mark.parametrize(("ending", "save"), [("sdf", write_sdf), ("bcrf", write_bcrf)])
def test_a_mark_in_the_first_stored_corner_lies_at_the_smallest_x_and_y(tmp_path, ending, save):
    z = np.nan_to_num(surface())
    z[0, 0], z[0, -1] = 0.9, -0.9  # first row, first and last number
    save(tmp_path / f"rock.{ending}", z)
    heights = read_scan(tmp_path / f"rock.{ending}")
    np.testing.assert_allclose(heights, z, atol=1e-6)
    assert "'first_row: top'" in heights.attrs["notes"]
    turned = read_scan(tmp_path / f"rock.{ending}", {"first_row": "top"})
    np.testing.assert_allclose(turned, z[::-1], atol=1e-6)
