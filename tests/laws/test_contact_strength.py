"""Shear strength from the contact itself: saw teeth, flat faces, reciprocity."""

from dataclasses import replace

import numpy as np
import pytest
from made_settings import made_settings
from made_stages import scan, stages_of

from fractalcontact.core.limits import FRICTION_FACTORS
from fractalcontact.joint.contact_dips import PARTS, contact_dips, dips_by_force
from fractalcontact.joint.joint import composite_topography
from fractalcontact.laws.contact_strength import (
    OF_CONTACTS,
    contact_strength,
    friction_of_dips,
    sampling_error,
)
from fractalcontact.study.configuration import solver_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine

SPACING, BASIC = 0.1, 30.0
SOLVER = solver_settings({}, "made")


def settings_of(**stated):
    load = (5.0, "pressure")
    return made_settings(
        **{
            **{"loads": [load], "dilatancy_loads": [load], "map_load": load, "window": 3.2},
            **{"directions": ["E"], "contact_directions": ["E"], "resolutions": [1]},
        }
        | stated
    )


def saw_teeth(angle, length=16, cells=65):
    """Teeth across x, of a slope both ways, mm; even about the middle, so without a tilt."""
    along = (np.arange(cells) - cells // 2) % length
    rise = np.minimum(along, length - along) * SPACING
    return np.tile(np.tan(np.radians(angle)) * rise, (cells, 1))


def specimen_of(*faces, **stated):
    arguments = window_arguments(settings_of(**stated))
    return make_specimen(*(scan(face, SPACING) for face in faces), name="made", **arguments)


@pytest.mark.parametrize("direction", ["E", "W"])
@pytest.mark.parametrize("angle", [10.0, 25.0])
def test_saw_teeth_that_match_have_the_angle_of_their_flanks_wherever_they_touch(angle, direction):
    """Slid by three cells: every node of the flanks that touch, also beside tips and valleys."""
    specimen = specimen_of(saw_teeth(angle))
    dips = contact_dips(specimen, direction, 3, 1)
    height = composite_topography(specimen, direction, 3)
    touching = height > height.max() - 1e-9
    assert touching.sum() > 100
    np.testing.assert_allclose(dips[touching], angle, atol=1e-9)
    by_force = dips_by_force(touching.astype(float), dips)
    ratio, truncated = friction_of_dips(by_force, BASIC)
    assert ratio == pytest.approx(np.tan(np.radians(BASIC + angle)), rel=1e-9)
    assert truncated == 0


def test_a_solved_joint_of_saw_teeth_has_their_strength():
    """Through solver, stages and the stage strength; steeper than 70 degrees is truncated."""
    settings = settings_of(offsets=[0.3, 0.5], map_offset=0.3)
    settings = replace(settings, material=replace(settings.material, basic_friction_angle=BASIC))
    for angle, expected in ((20.0, BASIC + 20), (60.0, 70.0)):
        found = stages_of("made", [scan(saw_teeth(angle), SPACING)], settings, SOLVER)["strength"]
        tau = found["contact_strength"].sel(contact_direction="E").squeeze()
        np.testing.assert_allclose(tau, 5 * np.tan(np.radians(expected)), rtol=1e-4)
        assert (found["contact_truncated"] == (angle > 40)).all()
        assert (found["peak_contact_strength"] == tau.max()).all()
        # What is truncated is a bound, whose interval does not pass it.
        assert (found["peak_contact_valid"] == (angle < 40)).all()
        bound = "only a lower bound, as most angles are truncated at 70 degrees"
        assert found["peak_contact_reason"].item() == ("" if angle < 40 else bound)
        bound = 5 * np.tan(np.radians(70))
        assert not (found["peak_contact_strength_high"] > bound * (1 + 1e-6)).any()


def test_flat_faces_have_the_basic_friction_angle():
    dips = contact_dips(specimen_of(np.zeros((64, 64))), "N", 2, 1)
    assert not np.nanmax(np.abs(dips))
    by_force = dips_by_force(np.ones(dips.shape), dips)
    ratio, _ = friction_of_dips(by_force, BASIC)
    assert ratio == pytest.approx(np.tan(np.radians(BASIC)), rel=1e-12)


def test_exchanging_the_faces_changes_nothing():
    """Turned over, the lower block is the upper one, and slides the other way."""
    first, second = (
        self_affine((64, 64), SPACING, 0.8, rms=0.1, seed=seed, roll_off=1.5) for seed in (1, 2)
    )
    stated = {"offsets": [0.0]}
    one = contact_dips(specimen_of(first, second, **stated), "E", 0, 1)
    other = contact_dips(specimen_of(-second, -first, **stated), "W", 0, 1)
    np.testing.assert_allclose(one, other, atol=1e-9)


def test_coarser_nodes_have_slopes_over_their_own_spacing():
    """A plane has its slope at every resolution and step; a short wave none over its length."""
    x = np.arange(64)
    wave = np.tile(0.2 * x * SPACING + 0.05 * np.sin(np.pi * x / 2), (64, 1))
    specimen = specimen_of(wave)
    # The mean plane of the scan is taken off: its dip is that of the wave alone.
    for factor, step in ((4, 1), (2, 2), (1, 4)):
        dips = contact_dips(specimen, "E", 0, factor, step)
        assert dips.shape == (32 // factor, 32 // factor)
        assert np.abs(dips).max() < 1


def test_parts_of_the_force_keep_its_mean_dip_and_split_nodes():
    pressure, dips = np.array([[1.0, 3.0]]), np.array([[40.0, -10.0]])
    parts = dips_by_force(pressure, dips)
    assert parts.mean() == pytest.approx(2.5)
    assert parts[: 3 * PARTS // 4] == pytest.approx(-10)
    assert parts[-1] == pytest.approx(40)
    assert np.isnan(dips_by_force(0 * pressure, dips)).all()


def test_no_friction_angle_is_no_strength():
    found = contact_strength(
        np.zeros((2, 1, 1, PARTS)), np.ones((1, 1)), 0.0, pressure=np.array([5.0]), angle=np.nan
    )
    assert np.isnan(found["contact_strength"]).all()
    assert np.isnan(found["contact_truncated"]).all()


def test_an_interval_ends_where_every_angle_is_truncated():
    dips = np.zeros((2, 1, 1, PARTS))
    dips[0] = 39
    found = contact_strength(dips, np.ones((1, 1)), 0.0, pressure=np.array([5.0]), angle=BASIC)
    ends = found["peak_contact_strength_low"], found["peak_contact_strength_high"]
    half = 5 * (np.tan(np.radians(BASIC + 39)) - np.tan(np.radians(BASIC)))
    most = 5 * np.tan(np.radians(70))
    peak = 5 * np.tan(np.radians(BASIC + 39))
    np.testing.assert_allclose(np.ravel(ends), [peak - half, most])
    assert half + peak > most


def test_peaks_have_the_uncertainty_of_the_basic_friction_angle():
    """Measured: 13 %. Assumed: 0.9 to 1.9 times by Barton's law, 10 degrees by the others.

    No end lies beyond 70 degrees.
    """
    settings = settings_of(offsets=[0.3, 0.5], map_offset=0.3)
    rock = replace(settings.material, basic_friction_angle=BASIC, joint_wall_strength=50.0)
    widths = {}
    for source, (low, high) in FRICTION_FACTORS.items():
        material = replace(rock, basic_friction_angle_is=source)
        made = stages_of(
            "made", [scan(saw_teeth(5.0), SPACING)], replace(settings, material=material), SOLVER
        )["strength"].squeeze()
        assert made.attrs["basic_friction_angle_is"] == source
        tau = float(made["barton_strength"])
        steepest = 5 * np.tan(np.radians(70))
        assert made["barton_strength_low"] == pytest.approx(low * tau)
        assert made["barton_strength_high"] == pytest.approx(min(high * tau, steepest))
        for name in ("peak_strength", "peak_contact_strength"):
            value, ends = float(made[name]), (made[f"{name}_low"], made[f"{name}_high"])
            apart = low * value, high * value
            if source == "assumed":
                angle = np.degrees(np.arctan(value / 5))
                apart = [5 * np.tan(np.radians(angle + off)) for off in (-10, 10)]
            assert ends[0] <= apart[0] * (1 + 1e-9)
            assert ends[1] >= min(apart[1], steepest) * (1 - 1e-9)
        widths[source] = float(made["peak_strength_high"] - made["peak_strength_low"])
    assert widths["measured"] < widths["assumed"]


def test_error_over_realisations_falls_with_the_number_of_contacts():
    """Equal dips have none by count; what they add to phi_b scatters with the amplitude."""
    dips = np.tile([10.0, 30.0], (2, 1, 50))  # two offsets, one load
    few, many = sampling_error(dips, np.array([[4.0], [100.0]]), 0.0, np.array([5.0]), BASIC)[:, 0]
    friction = np.tan(np.radians(BASIC + np.array([10.0, 30.0])))
    assert few == pytest.approx(1.96 * OF_CONTACTS * 5 * np.ptp(friction) / 2 / 2, rel=1e-3)
    assert many == pytest.approx(few / 5)
    equal = np.full((1, 1, 100), 20.0)
    assert sampling_error(equal, np.ones((1, 1)), 0.0, np.array([5.0]), BASIC) == pytest.approx(0)
    above = np.tan(np.radians(BASIC + 20)) - np.tan(np.radians(BASIC))
    by_amplitude = sampling_error(equal, np.ones((1, 1)), 0.1, np.array([5.0]), BASIC)
    assert by_amplitude == pytest.approx(1.96 * 5 * 0.1 * above, rel=1e-3)
