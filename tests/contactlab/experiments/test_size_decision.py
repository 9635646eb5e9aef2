"""The rule of decision on worlds that are made: one in which eq. 6 is true, and others."""

import numpy as np
import pytest

from contactlab.experiments.size_decision import (
    OPEN,
    REFUTED,
    SUPPORTED,
    UNKNOWN,
    Exponent,
    decide,
    mean_exponent,
    overall,
    quantile,
    size_exponent,
)

SIDES = np.repeat([128, 256, 512, 1024], 12)
DELTA = np.array([1.4, 1.55, 1.7])


def _world(exponent, seed, scatter=0.05):
    """A_r/A_0 of 12 surfaces of each side, as b to an exponent but for scatter."""
    noise = np.random.default_rng(seed).normal(0, scatter, SIDES.size)
    return 0.01 * (SIDES / 128.0) ** exponent * np.exp(noise)


def _known(value, error=0.01):
    return Exponent(value, value - 3 * error, value + 3 * error, error=error)


@pytest.mark.parametrize("delta", DELTA)
def test_dilations_of_one_contact_set_follow_eq_6(delta):
    # b/2 of a set of dimension Delta touches at 2^(2 - Delta) times the part of its area.
    alpha = size_exponent(SIDES, _world(delta - 2, seed=1))
    wanted = _known(delta - 2)
    assert decide(alpha, wanted, wanted).verdict == SUPPORTED


@pytest.mark.parametrize("delta", DELTA)
def test_a_world_without_size_effect_refutes_eq_6(delta):
    alpha = size_exponent(SIDES, _world(0.0, seed=2, scatter=0.02))
    found = decide(alpha, _known(delta - 2), _known(delta - 2.4))
    assert found.verdict == REFUTED
    assert found.no_size_effect


def test_the_wrong_exponent_refutes_eq_6_but_is_a_size_effect():
    found = decide(size_exponent(SIDES, _world(-0.15, seed=3)), _known(-0.4), _known(-0.7))
    assert found.verdict == REFUTED
    assert not found.no_size_effect


def test_one_of_two_estimators_is_enough_to_agree():
    alpha = size_exponent(SIDES, _world(-0.4, seed=4))
    assert decide(alpha, _known(-0.4), _known(-0.9)).verdict == SUPPORTED
    assert decide(alpha, _known(-0.9), _known(-0.4)).verdict == SUPPORTED


def test_what_is_too_wide_decides_nothing():
    alpha = size_exponent(SIDES, _world(0.0, seed=5))
    assert decide(alpha, _known(-0.3, 0.2), _known(-0.5)).verdict == OPEN
    # A wide interval that leaves alpha out refutes all the same.
    assert decide(alpha, _known(-1.5, 0.1), _known(-0.5)).verdict == REFUTED
    assert decide(alpha, UNKNOWN, UNKNOWN).verdict == OPEN
    assert decide(alpha, UNKNOWN, _known(-0.5)).verdict == OPEN
    assert decide(UNKNOWN, _known(-0.5), _known(-0.5)).verdict == OPEN


def test_a_prediction_of_no_effect_supports_nothing():
    alpha = size_exponent(SIDES, _world(0.0, seed=6, scatter=0.01))
    assert decide(alpha, _known(-0.004, 0.001), _known(-0.5)).verdict == OPEN


def test_exponents_cover_the_truth():
    # 99 %, so that in 300 worlds 3 miss; 11 or more happen once in 3,000.
    missed = 0
    for seed in range(300):
        one = size_exponent(SIDES, _world(-0.3, seed=seed))
        missed += not one.low <= -0.3 <= one.high
    assert missed <= 10
    spread = np.sqrt(np.sum((np.log(SIDES) - np.log(SIDES).mean()) ** 2))
    assert one.error == pytest.approx(0.05 / spread, rel=0.5)


def test_noisier_sides_weigh_less():
    values = _world(-0.3, seed=7)
    values[SIDES == 1024] *= np.exp(np.random.default_rng(8).normal(0, 3, 12))
    plain = size_exponent(SIDES[SIDES < 1024], values[SIDES < 1024])
    assert size_exponent(SIDES, values).value == pytest.approx(plain.value, abs=0.02)


def test_too_little_is_unknown():
    assert np.isnan(size_exponent([128] * 5, np.ones(5)).value)
    assert np.isnan(size_exponent([128, 256], [1.0, 1.0]).value)
    assert np.isnan(mean_exponent([1.0]).value)
    assert np.isnan(mean_exponent([np.nan, 1.0]).value)


def test_mean_exponents_have_the_interval_of_student():
    found = mean_exponent([1.0, 2.0, 3.0, np.nan])
    assert found.value == 2
    assert found.error == pytest.approx(1 / np.sqrt(3))
    # From a table: t of 0.995 with two degrees of freedom.
    assert found.high - found.value == pytest.approx(9.925 / np.sqrt(3), rel=1e-3)
    assert quantile(1e9) == pytest.approx(2.5758, abs=1e-4)
    # And t of 0.975 for the half-width that figures show.
    assert found.half_width == pytest.approx(4.3027 / np.sqrt(3), rel=1e-4)


def test_the_difference_of_exponents_has_the_joint_error():
    first, second = mean_exponent([1.0, 2.0, 3.0]), mean_exponent([0.0, 4.0, 5.0, 7.0])
    found = first.less(second)
    assert found.value == first.value - second.value
    for name in ("error", "half_width"):
        assert getattr(found, name) ** 2 == pytest.approx(
            getattr(first, name) ** 2 + getattr(second, name) ** 2
        )
    assert found.high - found.value == pytest.approx(
        np.hypot(first.high - first.value, second.high - second.value)
    )


def test_overall_needs_three_loads_and_the_change_with_h():
    alpha = size_exponent(SIDES, _world(-0.4, seed=9))
    yes = decide(alpha, _known(-0.4), _known(-0.4))
    no = decide(alpha, _known(0.4), _known(0.4))
    assert overall([yes, yes, yes], follows=True) == "eq. 6 supported"
    assert overall([yes, yes, yes], follows=False) == OPEN
    assert overall([yes, yes], follows=True) == OPEN
    assert overall([no, no], follows=True) == REFUTED
    assert overall([yes, no], follows=True) == OPEN
