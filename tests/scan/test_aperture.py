"""Aperture maps: the negative of the opening, their outline, zeros outside a specimen."""

import numpy as np
import pytest
import xarray as xr
from places import SCANS
from scan_writers import WRITERS, write

from fractalcontact.core.errors import InputError
from fractalcontact.flow.cubic_law import plane_flow
from fractalcontact.joint.joint import composite_topography
from fractalcontact.scan.raw import IncompleteSidecar
from fractalcontact.scan.read import read_faces, read_scan
from fractalcontact.surface.specimen import make_specimen

STEP = 0.1


def apertures(shape=(40, 40), seed=3):
    """Openings in mm, some of them contact, one not measured."""
    opening = np.maximum(np.random.default_rng(seed).normal(0.2, 0.2, shape), 0)
    opening[5, 7] = np.nan
    return opening


def round_core(n=40):
    """A round specimen in its square, zeros outside."""
    y, x = np.indices((n, n)) - (n - 1) / 2
    return np.where(np.hypot(x, y) <= n / 2, np.nan_to_num(apertures((n, n))), 0)


@pytest.mark.parametrize("ending", sorted(WRITERS))
def test_an_aperture_map_of_any_format_is_read_as_its_negative(tmp_path, ending):
    path = tmp_path / f"joint{ending}"
    keys = write(path, apertures(), STEP, STEP) | {"kind": "aperture"}
    keys.pop("heights", None)
    read = -read_scan(path, keys).values
    np.testing.assert_allclose(read, apertures(), atol=1e-6)


def test_the_wedge_of_an_aperture_map_stays(tmp_path):
    rng = np.random.default_rng(2)
    x, y = rng.uniform(0, 4, (2, 3000))
    wedge = 0.3 * x + rng.uniform(0, 0.01, x.size)  # 17 degrees: a face would be turned level
    path = tmp_path / "joint.npy"
    np.save(path, np.column_stack([x, y, wedge]))
    keys = {"kind": "aperture", "layout": "points", "columns": [0, 1, 2], "unit": "mm"}
    read = read_scan(path, keys | {"missing": "none"})
    along = np.polyfit(read.x, -read.mean("y"), 1)
    assert along[0] == pytest.approx(0.3, abs=0.005)
    specimen = make_specimen(read, opposite="aperture", window=2.0)
    composite = composite_topography(specimen, "none", 0)
    assert np.polyfit(np.arange(composite.shape[1]), composite.mean(axis=0), 1)[0] < -0.005
    assert specimen.attrs["tilt_degrees"] == 0


def test_an_aperture_map_is_the_joint_of_the_faces_it_lies_between(tmp_path):
    """Pressed without sliding, both have one composite topography but for its datum."""
    opening = np.nan_to_num(apertures(), nan=0.1)
    face = np.random.default_rng(4).normal(0, 0.5, opening.shape)
    paths = {name: tmp_path / f"{name}.npy" for name in ("map", "lower", "upper")}
    heights = {"map": opening, "lower": face, "upper": face + opening}
    keys = [write(paths[name], z, STEP, STEP) for name, z in heights.items()]
    of_map = {k: v for k, v in keys[0].items() if k != "heights"} | {"kind": "aperture"}
    pair = read_faces(paths["lower"], paths["upper"], keys[1] | {"registration": "none"})
    one = make_specimen(read_scan(paths["map"], of_map), opposite="aperture", window=2.0)
    two = make_specimen(*pair, window=2.0)
    of_both = (composite_topography(one, "none", 0), composite_topography(two, "E", 0))
    of_one, of_two = (h.max() - h for h in of_both)
    np.testing.assert_allclose(of_one, of_two, atol=1e-12)


def test_zeros_outside_a_round_specimen_are_refused_or_outlined_but_never_contact(tmp_path):
    path = tmp_path / "core.npy"
    keys = write(path, round_core(), STEP, STEP) | {"kind": "aperture"}
    del keys["heights"]
    with pytest.raises(InputError, match=r"zeros that reach in from its corners.*outline: disc"):
        read_scan(path, keys)
    disc = read_scan(path, keys | {"outline": "disc"})
    assert np.isnan(disc.values[[0, 0, -1, -1], [0, -1, 0, -1]]).all()
    inside = np.isfinite(disc.values)
    assert inside.mean() == pytest.approx(np.pi / 4, abs=0.02)
    np.testing.assert_allclose(-disc.values[inside], round_core()[inside])
    assert np.isnan(read_scan(path, keys | {"outline": {"mask": 0}}).values[0, 0])
    assert read_scan(path, keys | {"outline": "rectangle"}).values[0, 0] == 0
    np.save(path, np.pad(round_core(), 5))  # a margin: the largest disc in the map is too wide
    with pytest.raises(InputError, match=r"'outline' runs through zeros over 100 % of its length"):
        read_scan(path, keys | {"outline": "disc"})
    np.save(path, round_core())
    corners = {"polygon": [[1, 1], [3, 1], [3, 3], [1, 3]]}
    assert np.isfinite(read_scan(path, keys | {"outline": corners}).values).sum() == 400


def test_what_names_itself_an_aperture_is_not_read_as_a_face_unasked(tmp_path):
    for path, name in ((tmp_path / "a.nc", "aperture"), (tmp_path / "joint_gap.nc", "z")):
        step = {"units": "mm"}
        places = {axis: (axis, STEP * np.arange(40), step) for axis in "yx"}
        xr.Dataset({name: (("y", "x"), apertures(), step)}, places).to_netcdf(path)
        with pytest.raises(IncompleteSidecar, match="kind: aperture"):
            read_scan(path)
        np.testing.assert_allclose(read_scan(path, {"kind": "face"}).values, apertures())
        np.testing.assert_allclose(read_scan(path, {"kind": "aperture"}).values, -apertures())


@pytest.mark.skipif(not SCANS.is_dir(), reason="the folder of real scans is absent")
@pytest.mark.full
def test_a_measured_aperture_map_and_the_faces_of_the_joint_let_pass_alike():
    folder = SCANS / "cnl_granite_pair"
    stated = {"delimiter": "comma", "decimal": ".", "layout": "points", "missing": "none"}
    stated |= {"grid": "0.3 mm"}
    of_map = {"kind": "aperture", "header": 1, "columns": [1, 2, 3], "unit_xy": "mm", "unit_z": "m"}
    opening = -read_scan(folder / "Extracted_M_CNL_Aperture.csv", stated | of_map)
    of_faces = {"kind": "face", "lower": {"header": 2}, "upper": {"header": 0}, "unit": "mm"}
    of_faces |= {"columns": [0, 1, 2], "heights": "up", "registration": "none"}
    pair = (folder / f"Extracted_M_CNL_Side{side}.txt" for side in ("A_bottom", "B_top"))
    z_l, z_u = read_faces(*pair, stated | of_faces)
    window = {"x": slice(-10.2, 28), "y": slice(-20, 18)}
    gap = (z_u - z_l).sel(window).values
    opening = opening.interp(x=z_l.x, y=z_l.y).sel(window).values
    assert opening.mean() == pytest.approx(gap.mean(), rel=0.005)
    for axis in "xy":
        of_both = [
            plane_flow(np.maximum(one, 0), (0.3, 0.3), axis).transmissivity
            for one in (opening, gap)
        ]
        assert of_both[0] == pytest.approx(of_both[1], rel=0.05)
