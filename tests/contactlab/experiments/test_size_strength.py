"""Size effect of the strength: mated faces, exact dilatancy, and what made worlds are taken for."""

import numpy as np
import pytest

from contactlab.experiments.mated_faces import (
    face_class,
    height_difference,
    mated_composite,
    sliding_face,
)
from contactlab.experiments.size_decision import Exponent, size_exponent
from contactlab.experiments.size_strength import size_strength, sliding_joint, sliding_states
from contactlab.experiments.strength_decision import (
    EFFECT,
    FLAT,
    OF_B,
    OF_V,
    OPEN,
    friction_ratio,
    joint_verdict,
    linear_strengths,
    mean_strength,
    size_verdict,
    strength_exponent,
)
from contactlab.experiments.strength_exponents import (
    dilatancy_rates,
    equal_fractions,
    strength_exponents,
)
from contactlab.experiments.units import E_STAR, SPACING
from fractalcontact import HalfSpace, solve_contact
from fractalcontact.core.errors import InputError
from fractalcontact.laws.strength import dilatancy_angle, from_flush, shear_strength
from roughcontact.contact.corrected_area import corrected_area

RECIPE = {
    "hurst": [0.8],
    "loads": [0.02, 0.05],
    "hardness": 0.5,
    "cut_off": 4,
    "roll_off": 8,
    "rms_slope": 0.3,
    "basic_friction_angle": 30,
    "offsets": [2, 4, 8],
    "sizes": [32, 64],
    "surfaces": [4, 3],
}


@pytest.fixture(scope="module")
def states():
    return sliding_states(RECIPE, 1e-6)


@pytest.fixture(scope="module")
def found(states):
    return strength_exponents(states, RECIPE)


def test_mean_square_of_the_composite_is_the_height_difference():
    recipe = RECIPE | {"cut_off": 8, "roll_off": 32, "sizes": [128]}
    faces = face_class(0.8, recipe)
    offsets = [2, 8, 32]
    drawn = [
        [np.mean(mated_composite(face, v) ** 2) for v in offsets]
        for face in (sliding_face(faces, 128, 32, n) for n in range(12))
    ]
    error = np.std(drawn, axis=0, ddof=1) / np.sqrt(12)
    expected = height_difference(np.array(offsets, float), faces)
    assert (abs(np.mean(drawn, axis=0) - expected) < 4 * error + 0.01 * expected).all()


def test_height_difference_has_both_limits():
    faces = face_class(0.8, RECIPE)
    near = height_difference(np.array([1e-3, 2e-3]), faces)
    # Half of the mean square slope lies along x.
    assert near[0] == pytest.approx(1e-6 * RECIPE["rms_slope"] ** 2 / 2, rel=0.02)
    assert near[1] == pytest.approx(4 * near[0], rel=1e-4)
    # Twice the integral of C(q) q dq / (2 pi), part by part.
    low, high, power = 2 * np.pi / 8, 2 * np.pi / 4, -2 * 0.8
    above = (high**power - low**power) / power
    square = faces.prefactor * (low ** (power - 2) * low**2 / 2 + above) / (2 * np.pi)
    assert height_difference(np.array(4000.0), faces) == pytest.approx(2 * square, rel=0.01)


def test_a_face_slides_towards_x():
    """The hill of the lower face meets the window where it has come to, its copy where it was."""
    face = np.zeros((16, 22))
    face[5, 9] = 1.0
    composite = mated_composite(face, 6)
    assert np.unravel_index(composite.argmax(), composite.shape) == (5, 3)
    assert np.unravel_index(composite.argmin(), composite.shape) == (5, 9)
    assert composite.mean() == pytest.approx(0, abs=1e-15)


def test_loads_are_counted_in_the_slope_of_faces_that_do_not_match():
    """Beyond the roll-off that of the composite is sqrt(2) times a face's."""
    recipe = {
        **RECIPE,
        "cut_off": 8,
        "roll_off": 16,
        "sizes": [128],
        "offsets": [32],
        "loads": [0.02],
    }
    del recipe["hardness"]
    face = sliding_face(face_class(0.8, recipe), 128, 32, 0)
    joint = sliding_joint(face, recipe, 1e-5, "faces")
    composite = mated_composite(face, 32)
    slope = np.sqrt(sum(np.mean(np.diff(composite, axis=axis) ** 2) for axis in (0, 1)))
    space = HalfSpace(composite.shape, (SPACING, SPACING), E_STAR)
    area = space.cell_area * composite.size
    state = solve_contact(composite, space, force=0.02 * E_STAR * slope / SPACING * area)
    share = corrected_area(state.in_contact, SPACING) / area
    assert joint["corrected_share"].item() == pytest.approx(float(share), rel=0.1)


def test_faces_that_have_not_slid_are_flush():
    face = sliding_face(face_class(0.8, RECIPE), 32, 8, 0)
    assert not mated_composite(face, 0).any()


def _ridges(size, reach, slope, period):
    """A face of triangular ridges across x, all flanks of one slope."""
    x = np.arange(size + reach) % period
    return np.tile(slope * np.minimum(x, period - x).astype(float), (size, 1))


def test_ridges_climb_at_the_angle_of_their_flanks():
    slope, period = 0.4, 16
    recipe = {"offsets": [2, 4, 6], "loads": [1e-4, 2e-4], "rms_slope": slope}
    joint = sliding_joint(_ridges(64, 6, slope, period), recipe, 1e-9, "ridges")
    # All plateaus touch, and nothing else: the separation is linear in the load.
    unloaded = 2 * joint["separation"][0, :, 0] - joint["separation"][0, :, 1]
    np.testing.assert_allclose(unloaded, slope * np.array([2, 4, 6]), rtol=1e-6)
    rates = np.diff(np.r_[0, unloaded]) / 2
    np.testing.assert_allclose(rates, slope, rtol=1e-6)
    np.testing.assert_allclose(
        friction_ratio(rates, 30), np.tan(np.radians(30) + np.arctan(slope)), rtol=1e-6
    )


def test_a_tilted_plane_has_no_dilatancy_of_its_own():
    face = np.tile(0.3 * np.arange(40.0), (32, 1))
    joint = sliding_joint(face, {"offsets": [4], "loads": [0.01], "rms_slope": 0.3}, 1e-6, "plane")
    np.testing.assert_allclose(joint["separation"], 0, atol=1e-9)


def test_rates_are_those_of_the_dilatancy_angle(states):
    rates = dilatancy_rates(states)
    delta = states["separation"].values[1, 0, :, 1]
    _, angle = dilatancy_angle(*from_flush(states["offset"], delta))
    np.testing.assert_allclose(np.degrees(np.arctan(rates[1, 0, :, 1])), angle)


def test_strength_is_that_of_the_joints_where_nothing_is_truncated():
    rate = np.array([-0.2, 0.0, 0.5])
    strength, held = shear_strength(1.0, 30 + np.degrees(np.arctan(rate)))
    assert not held.any()
    np.testing.assert_allclose(friction_ratio(rate, 30), strength)
    # Truncated there, and not here; beyond the vertical there is none.
    assert friction_ratio(np.array(1.5), 30) > np.tan(np.radians(80))
    assert np.isnan(friction_ratio(np.array(2.0), 30))


def test_units_of_length_change_nothing(states):
    """Faces twice as high under the same p/(E* h'): twice the separation, the same contact."""
    face = sliding_face(face_class(0.8, RECIPE), 32, 8, 0)
    twice = sliding_joint(2 * face, RECIPE | {"rms_slope": 0.6}, 1e-6, "")
    once = states.isel(surface=0)
    np.testing.assert_allclose(twice["separation"], 2 * once["separation"], rtol=1e-4)
    np.testing.assert_allclose(twice["corrected_share"], once["corrected_share"], rtol=1e-3)


def test_capped_joints_yield_and_come_closer(states):
    elastic, capped = states.sel(law="elastic"), states.sel(law="capped")
    assert (capped["separation"] < elastic["separation"]).all()
    assert (capped["corrected_share"] > elastic["corrected_share"]).all()
    assert (elastic["yielded"] == 0).all()
    assert capped["yielded"].max() > 0.2
    assert states["residual"].max() < 1e-5


def test_intervals_of_equal_fraction():
    found = equal_fractions(np.array([64.0, 128.0]), np.array([0.0, 4.0, 8.0, 16.0]))
    assert found == {(1 / 16, 1 / 8): {64.0: 1, 128.0: 2}}


def _world(power_of_b, *, noise=0.01, sizes=(128, 256, 512), seed=1):
    """States in which the separation is v^0.5 b^power, with some scatter."""
    recipe = RECIPE | {
        "sizes": list(sizes),
        "surfaces": [10] * len(sizes),
        "offsets": [4, 8, 16, 32],
        "roll_off": 32,
        "loads": [0.02],
    }
    made = sliding_states(
        recipe | {"sizes": [16, 16], "surfaces": [2, 2], "roll_off": 4}, 1e-3
    ).isel(surface=np.arange(10 * len(sizes)) % 4)
    sides = np.repeat(sizes, 10)
    made["of_size"] = ("surface", sides)
    made["number"] = ("surface", np.tile(np.arange(10), len(sizes)))
    rng = np.random.default_rng(seed)
    each = 1 + noise * rng.standard_normal(len(sides))
    v = made["offset"].values[:, np.newaxis]
    factor = (each * (sides / 128) ** power_of_b)[:, np.newaxis, np.newaxis, np.newaxis]
    made["separation"] = (made["separation"].dims, factor * v**0.5 * np.ones((2, 1, 1)))
    made["height_difference"] = (("hurst", "offset"), v.T)
    return strength_exponents(made, recipe)


def test_a_world_of_v_alone_is_recognised():
    found = _world(0.0)
    assert (found["pooled_exponent_verdict"] == FLAT).all()
    assert (found["scaled_strength_exponent_verdict"] == EFFECT).all()
    assert (found["scaled_strength_exponent"] < 0).all()
    assert (abs(found["beyond_exponent"]) < 0.02).all()
    assert (found["overall"] == OF_V).all()
    # S(v) = v is the square of this separation, so that the theory is exact.
    np.testing.assert_allclose(found["theory_strength"], found["strength"].isel(side=-1), rtol=0.02)
    np.testing.assert_allclose(found["theory_exponent"], found["predicted_exponent"], atol=0.02)


@pytest.mark.parametrize("power", [-0.2, 0.2])
def test_a_world_with_a_power_of_b_is_recognised(power):
    found = _world(power)
    assert (found["pooled_exponent_verdict"] == EFFECT).all()
    assert (np.sign(found["strength_exponent"]) == np.sign(power)).all()
    np.testing.assert_allclose(found["separation_exponent"], power, atol=0.02)
    assert (found["overall"] == OF_B).all()


def test_a_noisy_world_is_undetermined():
    found = _world(0.0, noise=0.4)
    assert (found["pooled_exponent_verdict"] == OPEN).all()
    assert (found["overall"] == OPEN).all()


def test_scatter_of_small_windows_makes_no_size_effect():
    """The mean of tan(phi_b + i) rises with the scatter of i; the strength of the mean does not."""
    rng = np.random.default_rng(3)
    sides = np.repeat([128, 512], 4000)
    rates = 0.5 + rng.standard_normal(8000) * np.where(sides == 128, 0.25, 0.06)
    exponent = strength_exponent(sides, rates, 30)
    assert abs(exponent.value) < 3 * exponent.error
    means = [friction_ratio(rates[sides == side], 30) for side in (128, 512)]
    assert np.log(np.nanmean(means[0]) / np.nanmean(means[1])) > 10 * exponent.error


def test_linear_strengths_have_the_strength_of_the_mean_rate():
    rates = np.array([0.1, 0.3, 0.5])
    values = linear_strengths(np.zeros(3), rates, 30)
    np.testing.assert_allclose(np.log(values).mean(), np.log(friction_ratio(rates.mean(), 30)))
    low, high = friction_ratio(np.array([0.299, 0.301]), 30)
    slope = (np.log(high) - np.log(low)) / 0.002
    np.testing.assert_allclose(np.diff(np.log(values)), 0.2 * slope, rtol=1e-4)
    # Error of the mean's strength by the same slope.
    mean = mean_strength(rates, 30)
    assert mean.error == pytest.approx(slope * mean.value * np.std(rates, ddof=1) / 3**0.5, 1e-4)


def test_equal_weights_give_the_ordinary_line():
    sides = np.repeat([1.0, 2.0, 4.0], 5)
    values = sides**-0.3
    assert size_exponent(sides, values, equal=True).value == pytest.approx(-0.3)
    bent = np.exp(np.repeat([0.0, 1.0, 0.0], 5))
    assert size_exponent(sides, bent, equal=True).value == pytest.approx(0)
    assert np.isnan(size_exponent(sides[:5], values[:5], equal=True).value)


def _exponent(value, half):
    return Exponent(value, value - half, value + half, error=half / 3)


@pytest.mark.parametrize(
    ("value", "half", "verdict"),
    [
        (0.01, 0.005, FLAT),  # excludes zero, and is of no consequence
        (0.0, 0.05, OPEN),
        (0.1, 0.05, EFFECT),
        (-0.1, 0.05, EFFECT),
        (np.nan, np.nan, OPEN),
    ],
)
def test_verdicts(value, half, verdict):
    assert size_verdict(_exponent(value, half)) == verdict


def test_verdict_on_both_kinds():
    flat, falls, wide = _exponent(0, 0.01), _exponent(-0.3, 0.05), _exponent(-0.3, 0.4)
    assert joint_verdict([flat], [falls], [falls]) == OF_V
    assert joint_verdict([falls], [falls], [falls]) == OF_B
    assert joint_verdict([flat], [falls], [flat]) == OF_B
    assert joint_verdict([flat], [flat], [flat]) == FLAT
    assert joint_verdict([flat], [falls], [wide]) == OPEN
    assert joint_verdict([wide], [falls], [falls]) == OPEN
    assert joint_verdict([], [], []) == OPEN


def test_atlas_has_every_class(found):
    assert dict(found.sizes) | {"surface": 7, "interval": 3, "fraction": 1} == dict(found.sizes)
    assert found.attrs["smallest_side"] == 32
    for name, variable in found.variables.items():
        if variable.dtype.kind == "f":
            assert variable.attrs["units"], name
    ends = found["strength_low"], found["strength"], found["strength_high"]
    assert (ends[0] <= ends[1]).all()
    assert (ends[1] <= ends[2]).all()
    assert np.isfinite(found["truncated_share"]).all()


def test_sizes_and_numbers_of_surfaces_belong_together():
    with pytest.raises(InputError, match="2 sizes and 1 numbers of surfaces"):
        size_strength(RECIPE | {"surfaces": [4]})
