"""Every file of the folder of real scans: read right, or refused in words that help."""

import struct
from pathlib import Path

import numpy as np
import pytest
from places import SCANS
from stated import read_scan

from fractalcontact.core.errors import InputError

INSTRUMENTS = SCANS / "instruments" / "surfacetopography"
pytestmark = [
    pytest.mark.scans,
    pytest.mark.skipif(not SCANS.is_dir(), reason="the folder of real scans is absent"),
]

MM = {"unit": "mm"}
MIXED = {"unit_xy": "mm", "unit_z": "um"}
UNITLESS = {"unit": "um", "spacing": 1}
CORONA = {"unit": "m", "variable": "Z_grid", "spacing": 0.005685771715431078}

#: File, sidecar, (ny, nx), (dx, dy) in mm, unit the file is in, cells missing or their share.
READ = [
    ("cnl_granite_pair/Extracted_M_CNL_SideA_bottom.txt", MM, None, (0.304, 0.304), "mm", None),
    ("cnl_granite_pair/Extracted_M_CNL_SideB_top.txt", MM, None, (0.304, 0.304), "mm", None),
    ("corona_fault/coronaA_grids.npz", CORONA, (388, 537), (5.68577, 5.68577), "m", 1460),
    ("grasselli_joint/example_surface.stl", MM, None, (0.196, 0.196), "mm", None),
    ("nanovea/test1.txt", MIXED, (101, 101), (0.005, 0.005), "x, y mm; z um", 0),
    ("nanovea/test4.txt", MIXED, (101, 101), (0.005, 0.005), "x, y mm; z um", 0),
    ("surfdiff_rock/BottomBlue.csv", MM, (88, 104), (1, 1), "mm", 0),
    ("surfdiff_rock/TopRed.csv", MM, (88, 104), (1, 1), "mm", 0),
    ("al3d-1.al3d", {}, (296, 200), (438.027e-6, 438.027e-6), "m", 0),
    ("bcrf-1.bcrf", {}, (600, 960), (1.777404 / 960, 1.110878 / 600), "nm", 0),
    ("frt-1.frt", {}, (500, 500), (0.024, 0.024), "m", 76456),
    ("matrix-3.txt", {}, (256, 256), (0.010 / 256, 0.010 / 256), "m", 0),
    ("metropro-1.dat", {}, (480, 640), (1.0982520e-3, 1.0982520e-3), "m", 0),
    ("mnt-1.mnt", {}, (600, 960), (1.777404 / 959, 1.110878 / 599), "µm", 0),
    ("nms-1.nms", {}, (512, 512), (0.160 / 512, 0.160 / 512), "µm", 0),
    ("plu-1.plu", {}, (576, 768), (1.66e-3, 1.66e-3), "µm", 0),
    ("sur-2.sur", {}, (484, 563), (3.484e-3, 3.484e-3), "mm", 117),
    ("tmd-1.tmd", {}, (300, 300), (18.9566 / 300, 18.9566 / 300), "mm", 0),
    ("../gwyfile/test.gwy", UNITLESS, (128, 128), (0.001, 0.001), "um", 0),
    ("../x3p/sample-land.x3p", {}, (256, 918), (2.58e-3, 2.58e-3), "m", 25292),
    ("../x3p/surface_binary.x3p", {}, (150, 200), (0.001, 0.001), "m", 180),
    ("../x3p/surface_xml.x3p", {}, (150, 200), (0.001, 0.001), "m", 180),
    ("../x3p/surface_irregular_xml.x3p", {}, (72, 96), (0.002, 0.002), "m", None),
]
REFUSED = [
    ("corona_fault/PaperStats.csv", {}, "such a file is read only with a complete sidecar"),
    ("nanovea/test1.txt", {}, "its sidecar lacks unit"),
    ("di_corrupted.di", {}, "not large enough to contain all data buffers"),
    ("gwyddion-export-english.txt", {}, "its sidecar lacks unit_xy"),
    ("gwyddion-export-german.txt", {}, "its sidecar lacks unit_xy"),
    ("sdf-1.sdf", {}, r"7 x 4 cells \(x, y\) are too few"),
    ("xyz-1.txt", MM, "only 16 points"),
    ("xyz-1-different-order.txt", MM, "only 16 points"),
    ("../gwyfile/test.gwy", {}, "states no unit and spacing"),
]


#: One file of each kind, small.
QUICK = {
    "nanovea/test1.txt",
    "tmd-1.tmd",
    "nms-1.nms",
    "../gwyfile/test.gwy",
    "../x3p/surface_binary.x3p",
    "../x3p/surface_irregular_xml.x3p",
    "di_corrupted.di",
    "gwyddion-export-german.txt",
}


def parameters(rows):
    """Rows with their names; all but `QUICK` are left to the full suite."""
    return [
        pytest.param(
            *row,
            id=f"{row[0]} {row[1]}" if len(row) == 3 else row[0],
            marks=() if row[0] in QUICK else pytest.mark.full,
        )
        for row in rows
    ]


def located(name):
    """Instruments' files are named alone."""
    folder = SCANS if (SCANS / name).exists() else INSTRUMENTS
    return folder / name


@pytest.mark.parametrize(
    ("name", "sidecar", "shape", "spacing", "unit", "missing"), parameters(READ)
)
def test_a_real_scan_is_read_right(name, sidecar, shape, spacing, unit, missing):
    heights = read_scan(located(name), sidecar)
    if shape is not None:
        assert heights.shape == shape
    if missing is not None:  # of a grid of its own, not of scattered points
        assert int(heights.isnull().sum()) == missing
    found = (heights.attrs["spacing_x"], heights.attrs["spacing_y"])
    assert found == pytest.approx(spacing, rel=2e-3 if missing is None else 1e-6)
    assert heights.attrs["file_unit"] == unit
    assert heights.attrs["overrides"] == ""


@pytest.mark.parametrize(("name", "sidecar", "message"), parameters(REFUSED))
def test_a_real_file_that_is_no_scan_is_refused(name, sidecar, message):
    with pytest.raises(InputError, match=rf"{Path(name).name}: .*{message}"):
        read_scan(located(name), sidecar)


def test_every_file_of_the_folder_is_listed_here():
    known = {located(row[0]).resolve() for row in READ + REFUSED}
    known.add((SCANS / "cnl_granite_pair" / "Extracted_M_CNL_Aperture.csv").resolve())  # no heights
    files = {path.resolve() for path in SCANS.rglob("*") if path.is_file()}
    assert {path for path in files - known if not path.name.startswith(("README", "LIC"))} == set()


# --- against the headers themselves, not against the library -----------------------------------


def header(name, form, offset):
    content = (INSTRUMENTS / name).read_bytes()
    return struct.unpack_from(form, content, offset)


def test_tmd_states_lengths_in_mm():
    nx, ny, length_x, length_y = header("tmd-1.tmd", "<IIff", 56)
    heights = read_scan(INSTRUMENTS / "tmd-1.tmd")
    assert heights.shape == (ny, nx)
    assert heights.attrs["spacing_x"] * nx == pytest.approx(length_x) == pytest.approx(18.9566)
    assert heights.attrs["spacing_y"] * ny == pytest.approx(length_y)
    # TrueMap meant 63.4 um from point to point, so n - 1 steps; the note says how much that is.
    assert length_x / (nx - 1) == pytest.approx(0.0634, rel=1e-6)
    assert "1.00334 x 1.00334 times" in heights.attrs["notes"]


def test_nms_counts_its_spacing_in_nm():
    nx, _, dx, dy = header("nms-1.nms", "<IIdd", 1368)
    low, high = header("nms-1.nms", "<dd", 16)
    heights = read_scan(INSTRUMENTS / "nms-1.nms")
    assert (heights.attrs["spacing_x"], heights.attrs["spacing_y"]) == pytest.approx(
        (dx * 1e-6, dy * 1e-6)
    )
    assert heights.attrs["spacing_x"] * nx == pytest.approx(0.160, rel=1e-6)
    relief = float(heights.max() - heights.min())
    assert relief == pytest.approx((high - low) * 1e-3, rel=1e-4)  # um
    assert "in nm" in heights.attrs["notes"]


@pytest.mark.full
def test_frt_states_its_field_in_m():
    (length_x, length_y) = header("frt-1.frt", "<dd", 56)
    heights = read_scan(INSTRUMENTS / "frt-1.frt")
    assert (length_x, length_y) == (0.012, 0.012)
    assert heights.attrs["spacing_x"] * 500 == pytest.approx(length_x * 1e3)
    assert float(heights.isnull().mean()) == pytest.approx(0.31, abs=0.005)


@pytest.mark.full
def test_sur_states_its_steps_and_units():
    steps = header("sur-2.sur", "<ff", 120)
    heights = read_scan(INSTRUMENTS / "sur-2.sur")
    assert (INSTRUMENTS / "sur-2.sur").read_bytes()[180:196].strip() == b"mm"
    assert (heights.attrs["spacing_x"], heights.attrs["spacing_y"]) == pytest.approx(steps)


def test_an_instrument_that_states_no_size_needs_the_sidecar(tmp_path):
    """MetroPro writes a lateral resolution of 0 where nobody calibrated it."""
    content = bytearray((INSTRUMENTS / "metropro-1.dat").read_bytes())
    (resolution,) = struct.unpack_from(">f", content, 184)
    assert resolution == pytest.approx(1.0982520e-6)  # m
    struct.pack_into(">f", content, 184, 0.0)
    path = tmp_path / "uncalibrated.dat"
    path.write_bytes(content)
    with pytest.raises(InputError, match="states no spacing"):
        read_scan(path)
    heights = read_scan(path, {"spacing": "1.098252 um"})
    np.testing.assert_array_equal(heights, read_scan(INSTRUMENTS / "metropro-1.dat"))


@pytest.mark.full
def test_one_measurement_in_two_formats_is_one_surface():
    """A .bcrf states the length from the first point to the last, a .mnt the steps."""
    bcr, mnt = (read_scan(INSTRUMENTS / name) for name in ("bcrf-1.bcrf", "mnt-1.mnt"))
    np.testing.assert_allclose(bcr, mnt, rtol=0, atol=1e-9)
    for axis, n in (("x", 960), ("y", 600)):
        ratio = mnt.attrs[f"spacing_{axis}"] / bcr.attrs[f"spacing_{axis}"]
        assert ratio == pytest.approx(n / (n - 1), rel=1e-6)
    assert "1.00104 x 1.00167 times" in bcr.attrs["notes"]


def test_the_german_decimal_comma_reads_as_the_point(tmp_path):
    """A real export with its points turned to commas, as Gwyddion writes it in German."""
    english = INSTRUMENTS / "matrix-3.txt"
    german = tmp_path / "deutsch.txt"
    german.write_text(english.read_text(encoding="utf-8").replace(".", ","), encoding="utf-8")
    np.testing.assert_array_equal(read_scan(german), read_scan(english))
    assert read_scan(german).attrs["spacing_x"] == pytest.approx(0.010 / 256)
