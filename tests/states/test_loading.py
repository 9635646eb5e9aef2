"""The loading of a joint, and what follows from it."""

import dataclasses

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.settings import Solver
from fractalcontact.joint.joint import composite_topography, describe_joint, sliding_axis
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.settlement import interface_closure
from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SOLVER = Solver(1e-6, "love", None)
STUDY = {
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.0}},
    "defaults": {
        "material": "rock",
        "directions": ["E", "N"],
        "contact_directions": ["E", "N"],
        "offsets": ["0.4 mm", "0.2 mm", "0.8 mm"],
        "map_offset": "0.8 mm",
        "loads": ["5 MPa", "1 MPa"],
        "resolutions": [1, 2],
    },
}


@pytest.fixture(scope="module")
def joint():
    """Specimen of oblong cells, its joint and settings."""
    heights = self_affine((48, 96), 0.1, 0.8, rms=0.05, seed=1)
    coords = [0.2 * np.arange(48), 0.1 * np.arange(96)]
    attrs = {"spacing_y": 0.2, "spacing_x": 0.1}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    settings = resolve_settings(STUDY, "rock", {}, "study")
    specimen = make_specimen(scan, window=3.2, name="rock", reach=1.0)
    return specimen, describe_joint(specimen, settings), settings


@pytest.mark.parametrize(("direction", "spacing"), [("E", 0.1), ("N", 0.2)])
def test_offsets_are_cells_of_the_direction(joint, direction, spacing):
    loading = JointLoading.of_joint(*joint[:2], direction, joint[2], SOLVER)
    np.testing.assert_allclose(
        loading.offsets, [0.2, 0.4, 0.8]
    )  # ascending, whatever the order stated
    np.testing.assert_allclose(loading.cells * spacing, loading.offsets)
    assert loading.at([3]).offsets == pytest.approx([3 * spacing])
    assert loading.at_map_offset().offsets == pytest.approx([0.8])
    np.testing.assert_array_equal(
        loading.composite(2), composite_topography(joint[0], direction, 2)
    )


def test_half_space_lies_under_the_window(joint):
    loading = JointLoading(joint[0], "E", [0], joint[2], SOLVER)
    assert loading.shape == (16, 32)
    assert loading.area == pytest.approx(3.2**2)
    coarse = loading.half_space((8, 16), 2)
    assert coarse.spacing == pytest.approx((0.4, 0.2))
    assert coarse.modulus == pytest.approx(20e3 / 2)
    np.testing.assert_allclose(loading.forces(joint[2].loads), np.array([1, 5]) * loading.area)
    assert loading.solving == {"rtol": 1e-6, "hardness": np.inf}


def test_it_cannot_be_changed(joint):
    loading = JointLoading(joint[0], "none", [0], joint[2], SOLVER)
    assert not loading.slides
    with pytest.raises(dataclasses.FrozenInstanceError):
        loading.cells = [1]


def test_axis_of_every_direction():
    assert [sliding_axis(direction) for direction in ("E", "N", "W", "S", "none")] == [
        1,
        0,
        1,
        0,
        0,
    ]


def test_flush_faces_have_nothing_to_close_and_offsets_keep_their_labels():
    closure = xr.DataArray(
        [3.0, 5.0], {"offset": ("offset", [0.0, 1.0], {"units": "mm"})}, dims="offset"
    )
    closing = interface_closure(closure, 1.0, xr.DataArray([True, False], dims="offset"))
    assert closing.values.tolist() == [0.0, 4.0]
    assert closing["offset"].attrs == {"units": "mm"}
    assert interface_closure(3.0, 1.0) == 2.0
    assert interface_closure(np.array([3.0, 4.0]), 1.0, True).tolist() == [0.0, 0.0]
