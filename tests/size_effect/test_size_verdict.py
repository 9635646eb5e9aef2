"""The rule that decides on eq. 6, and worlds in which it is true or not."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.verdicts import AGREES, AMBIGUOUS, FLATTER, NOT_TESTED, STEEPER, UNDECIDED
from fractalcontact.size_effect.load_ladder import OF_WINDOWS
from fractalcontact.size_effect.size_law import size_law
from fractalcontact.size_effect.size_verdict import (
    ILL_CONDITIONED,
    NEITHER,
    NOTHING_PREDICTED,
    SEVERAL,
    SLOPE_TOO_WIDE,
    TOO_WIDE,
    TOO_WIDE_MISSED,
    both_forms,
    judge_exponent,
    judge_own_form,
    size_verdicts,
)
from fractalcontact.size_effect.slope import slopes_at_equal_star

PARTS = np.array([1, 2, 4, 8])
LOADS = 4
DELTA = 1.5


def around(value, half):
    return Estimate(value, value - half, value + half)


def world(fraction, scatter=0.01, seed=0):
    """States of windows whose A_r/A_0 = fraction(sigma_0, b), each with a chance of its own."""
    side, pressure = 16.0 / PARTS, np.geomspace(1, 2048, 12)
    spacing = np.array([1e-3, 2e-3])
    shape = (len(PARTS), 64, len(pressure))
    chance = np.exp(scatter * np.random.default_rng(seed).normal(size=shape))
    share = fraction(pressure, side[:, np.newaxis])[:, np.newaxis] * chance
    present = np.arange(64) < np.square(PARTS)[:, np.newaxis]
    share = np.where(present[:, :, np.newaxis], share, np.nan)
    nodes = (share * side[:, np.newaxis, np.newaxis] ** 2)[:, :, np.newaxis]
    nodes = nodes / spacing[:, np.newaxis] ** 2
    dims = ("part", "window", "step")
    values = dict.fromkeys(OF_WINDOWS, 1 + 0 * share) | {"area_fraction": share}
    return xr.Dataset(
        {
            "nodes": (("part", "window", "resolution", "step"), nodes),
            "nodes_error": (("part", "window", "resolution", "step"), 0 * nodes),
            **{
                name: (dims, values[name], {"units": unit, "long_name": words})
                for name, (unit, words) in OF_WINDOWS.items()
            },
            "bulk_compliance": ("part", side),
            "side": ("part", side),
            "windows": ("part", PARTS**2),
            "ladder_pressure": ("step", pressure),
            "spacing": ("resolution", spacing),
        },
        coords={"part": PARTS, "normal_force": pressure[:LOADS] * 256},
    )


def judged(states, half=0.1, delta=DELTA):
    """Verdicts where Delta_sigma of the whole is known within ``half``."""
    result = size_law(states).merge(slopes_at_equal_star(states, LOADS))
    for end, by in (("", 0.0), ("_low", -half), ("_high", half)):
        result[f"predicted_slope{end}"] = (
            ("estimator", "normal_force"),
            np.full((1, LOADS), delta - 2 + by),
        )
    return result.merge(size_verdicts(result)).isel(estimator=0)


# -- worlds ----------------------------------------------------------------------------------------


def test_dilations_of_one_contact_set_follow_eq_6():
    # One set of dimension Delta at all sizes: A_r/A_0 ~ b^-(2 - Delta), whatever the load.
    found = judged(world(lambda p, b: 0.1 * b ** (DELTA - 2) + 0 * p))
    np.testing.assert_allclose(found["area_exponent"], DELTA - 2, atol=0.02)
    np.testing.assert_allclose(found["condition_number"], 1, atol=0.05)
    assert (found["area_verdict"] == AGREES).all()
    assert (found["slope_verdict"] == AGREES).all()
    assert (found["verdict"] == AGREES).all()
    assert found["size_effect"].all()


def test_a_world_without_a_size_effect_does_not():
    found = judged(world(lambda p, b: 1e-3 * p**0.8 + 0 * b))
    assert (found["area_exponent_low"] <= 0.01).all()
    assert (found["area_exponent_high"] >= -0.01).all()
    assert (found["area_verdict"] == FLATTER).all()
    assert (found["verdict"] == FLATTER).all()


def test_a_noisy_world_decides_nothing():
    found = judged(world(lambda p, b: 0.1 * b ** (DELTA - 2) + 0 * p, scatter=1.5))
    assert (found["verdict"] == UNDECIDED).all()
    assert (found["area_reason"] == NEITHER).sum() >= 3


def test_a_wide_prediction_decides_nothing():
    agreeing = judged(world(lambda p, b: 0.1 * b ** (DELTA - 2) + 0 * p), half=0.3)
    assert (agreeing["reason"] == TOO_WIDE).all()
    missed = judged(world(lambda p, b: 1e-3 * p**0.8 + 0 * b), half=0.3)
    assert (missed["reason"] == TOO_WIDE_MISSED).all()
    assert (missed["verdict"] == UNDECIDED).all()


def test_area_nearly_linear_in_the_load_leaves_the_own_form_undecided():
    # sigma* ~ sigma_0^0.05 b^0.5: the own form has the slope -10, and the condition number 20.
    found = judged(world(lambda p, b: 1e-3 * p**0.95 * b ** (DELTA - 2), scatter=0.0))
    assert (found["area_verdict"] == AGREES).all()
    assert (found["slope_verdict"] == UNDECIDED).all() | (
        found["slope_verdict"] == NOT_TESTED
    ).all()
    assert (found["verdict"] == UNDECIDED).all()


def test_units_change_nothing():
    states = world(lambda p, b: 1e-3 * p**0.6 * b**-0.2)
    one = judged(states)
    scaled = states.copy()
    for name, factor in (("side", 1e3), ("spacing", 1e3), ("mean_gap", 1e3)):
        scaled[name] = (factor * states[name]).assign_attrs(states[name].attrs)
    scaled["ladder_pressure"] = 1e-6 * states["ladder_pressure"]
    other = judged(scaled)
    for name in ("area_exponent", "area_exponent_high", "gap_exponent", "slope"):
        np.testing.assert_allclose(other[name], one[name], atol=1e-9)
    assert (other["verdict"] == one["verdict"]).all()


# -- the rule --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("measured", "predicted", "verdict", "reason"),
    [
        (around(-0.5, 0.1), around(-0.5, 0.1), AGREES, ""),
        (around(0.0, 0.1), around(-0.5, 0.1), FLATTER, ""),
        (around(-1.0, 0.1), around(-0.5, 0.1), STEEPER, ""),
        (around(-0.3, 0.4), around(-0.5, 0.1), UNDECIDED, NEITHER),
        (around(-0.5, 0.1), around(-0.5, 0.21), UNDECIDED, TOO_WIDE),
        (around(0.0, 0.1), around(-0.5, 0.3), UNDECIDED, TOO_WIDE_MISSED),
        (around(0.0, 0.1), around(-0.01, 0.1), UNDECIDED, NOTHING_PREDICTED),
        (Estimate(np.nan, np.nan, np.nan), around(-0.5, 0.1), NOT_TESTED, None),
        (around(-0.5, 0.1), Estimate(-0.5, np.nan, np.nan), NOT_TESTED, None),
        (around(-0.5, 0.0), around(-0.5, 0.0), AGREES, ""),
    ],
)
def test_rule(measured, predicted, verdict, reason):
    found = judge_exponent(measured, predicted)
    assert found.verdict == verdict
    assert reason is None or found.reason == reason
    assert found.difference.value == pytest.approx(measured.value - predicted.value, nan_ok=True)


@pytest.mark.parametrize(
    ("condition", "crossings", "half", "verdict", "reason"),
    [
        (1.0, 1, 0.1, AGREES, ""),
        (-9.9, 1, 0.1, AGREES, ""),
        (10.1, 1, 0.1, UNDECIDED, ILL_CONDITIONED),
        (-166.0, 1, 0.1, UNDECIDED, ILL_CONDITIONED),
        (np.nan, 1, 0.1, UNDECIDED, ILL_CONDITIONED),
        (np.inf, 1, 0.1, UNDECIDED, ILL_CONDITIONED),
        (1.0, 3, 0.1, AMBIGUOUS, SEVERAL),
        (1.0, 1, 0.6, UNDECIDED, SLOPE_TOO_WIDE),
    ],
)
def test_own_form_counts_only_where_it_is_well_conditioned(
    condition, crossings, half, verdict, reason
):
    found = judge_own_form(around(-0.7, half), around(-0.7, 0.1), condition, crossings)
    assert (found.verdict, found.reason) == (verdict, reason)


def test_both_forms_must_agree():
    yes = judge_exponent(around(-0.5, 0.1), around(-0.5, 0.1))
    no = judge_exponent(around(0.0, 0.1), around(-0.5, 0.1))
    ill = judge_own_form(around(-0.5, 0.1), around(-0.5, 0.1), 99.0, 1)
    assert both_forms(yes, yes)[0] == AGREES
    assert both_forms(yes, no)[0] == FLATTER
    assert both_forms(no, yes)[0] == FLATTER
    assert both_forms(yes, ill) == (UNDECIDED, ILL_CONDITIONED)
    assert both_forms(no, ill)[0] == FLATTER
