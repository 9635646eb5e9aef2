"""Dilatancy of other windows and readings: what is alike agrees, and what differs shows."""

from dataclasses import replace

import numpy as np
import pytest
from made_stages import scan

from fractalcontact.joint.joint import describe_joint
from fractalcontact.laws.closure import closure_curves, elastic_dilatancy
from fractalcontact.laws.slid_variants import OWN, QUARTER, READ, WINDOW, slid_variants
from fractalcontact.scan.other_readings import OTHER_FACES, READING
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.states import combine
from fractalcontact.states.sweep import contact_states
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine

STUDY = {
    "study": "slid",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2, "hardness": "200 MPa"}},
    "defaults": {
        **{"material": "rock", "contact_directions": ["E"], "loads": ["2 MPa", "10 MPa"]},
        **{"offsets": ["0.1 mm", "0.3 mm", "0.6 mm"], "resolutions": [1], "window": "3.2 mm"},
    },
    "specimens": {"rock": {}, "large": {"window": "6.4 mm"}},
}
SOLVER = solver_settings({}, "slid")


def joint_of(heights, name="rock", boundary="free"):
    settings = replace(resolve_settings(STUDY, name, {}, "slid"), boundary=boundary)
    specimen = make_specimen(scan(heights, 0.1), name=name, **window_arguments(settings))
    joint = describe_joint(specimen, settings)
    return JointLoading.of_joint(specimen, joint, "E", settings, SOLVER), joint


def rough(cells=80):
    return self_affine((cells, cells), 0.1, 0.8, rms=0.1, seed=5, roll_off=1.5)


@pytest.mark.parametrize("boundary", ["free", "mirrored"])
def test_this_window_has_the_dilatancy_of_the_stage(boundary):
    loading, joint = joint_of(rough(), boundary=boundary)
    force = loading.forces(loading.settings.loads)[1]
    found = slid_variants(loading, force)
    kinds, curves = found["variant_kind"][1], found["variant_dilatancy"][1]
    assert kinds == [OWN] + [WINDOW] * (len(kinds) - 1)
    assert curves.shape == (len(kinds), 3)
    sides = tuple(np.array(loading.shape) * 0.1)
    states = combine([contact_states(loading, [1])])
    curve = closure_curves(states, sides, loading.settings.material.e_star)
    own = elastic_dilatancy(curve, joint)["elastic_dilatancy"].isel(normal_force=1).values.ravel()
    np.testing.assert_allclose(curves[0], own, atol=2e-3 * np.ptp(own))
    assert np.ptp(curves[1:, -1]) > 0.01


def test_windows_that_repeat_each_other_dilate_alike():
    patch = self_affine((32, 32), 0.1, 0.8, rms=0.1, seed=7)
    loading, _ = joint_of(np.tile(patch, (3, 3)))
    curves = slid_variants(loading, 20.0)["variant_dilatancy"][1]
    moved = np.diff(curves, axis=1)
    np.testing.assert_allclose(moved, np.broadcast_to(moved[0], moved.shape), atol=0.02)


def test_quarters_stand_in_where_the_scan_has_no_other_windows():
    loading, _ = joint_of(rough(), "large")
    found = slid_variants(loading, 20.0)
    assert found["variant_kind"][1] == [OWN] + [QUARTER] * 4
    assert found["windows_independent"][1] == 4


def test_flush_faces_do_not_dilate():
    loading, _ = joint_of(rough())
    still = slid_variants(loading.at([0, 3]), 20.0)["variant_dilatancy"][1]
    np.testing.assert_array_equal(still[:, 0], 0)
    assert (still[:, 1] != 0).all()


def test_a_reading_is_a_variant_unless_it_has_a_hole_where_the_window_slides():
    loading, _ = joint_of(rough())
    own = np.stack([loading.specimen["lower"].values] * 2)
    other = own * 1.5
    holed = other.copy()
    holed[:, 40, 40] = np.nan
    for heights, n in ((other, 1), (holed, 0)):
        readings = {OTHER_FACES: ((READING, "face", "y", "x"), heights[np.newaxis])}
        specimen = loading.specimen.assign_coords(
            {READING: ["rougher"], "face": ["lower", "upper"]}
        ).assign(readings)
        specimen["upper"] = specimen["lower"]
        read = JointLoading(specimen, "E", loading.cells, loading.settings, SOLVER)
        found = slid_variants(read, 20.0)
        assert found["variant_kind"][1].count(READ) == n
