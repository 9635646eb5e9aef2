"""Laws of closure curves, and which of them is named."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from ensembles import ensemble
from scipy import stats

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.limits import GOOD_FIT
from fractalcontact.core.verdicts import HYPERBOLA, NEITHER, SEMI_LOGARITHMIC, UNDECIDED
from fractalcontact.laws.closure_laws import (
    add_closure_laws,
    at_twice,
    better_law,
    fit_hyperbola,
    fit_semi_logarithmic,
    undetermined_stiffness,
)

PRESSURE = np.geomspace(0.5, 100, 8)


def law_of(pressure, closure):
    return better_law(fit_hyperbola(pressure, closure), fit_semi_logarithmic(pressure, closure))


def hyperbola(pressure, k_ni=30.0, w_m=0.4):
    return pressure * w_m / (k_ni * w_m + pressure)


def test_a_hyperbola_is_found_again_exactly():
    w = np.linspace(0.01, 0.35, 8)
    sigma = 30 * w / (1 - w / 0.4)
    fit = fit_hyperbola(sigma, w)
    assert (fit.k_ni.value, fit.w_m.value) == pytest.approx((30, 0.4), rel=1e-6)
    assert fit.misfit < 1e-6
    assert fit.reason == ""


@pytest.mark.parametrize("seat", [0.01, 0.25, 5.0])
def test_closures_from_any_seat_give_the_constants_from_zero_load(seat):
    sigma = seat * np.geomspace(1.5, 100, 8)
    fit = fit_hyperbola(sigma, hyperbola(sigma) - hyperbola(seat), seat)
    assert (fit.k_ni.value, fit.w_m.value) == pytest.approx((30, 0.4), rel=1e-6)
    # As if the law were zero at the seat: the slope there, and not at zero load.
    assert fit_hyperbola(sigma, hyperbola(sigma) - hyperbola(seat)).k_ni.value > 30.003


@pytest.mark.parametrize("n", [4, 5, 9])
def test_the_interval_of_a_hyperbola_is_that_of_its_linear_part(n):
    """Student's t, of points less the two parameters, in the logarithms of these."""
    sigma = np.geomspace(2, 100, n)
    w = hyperbola(sigma) * (1 + 1e-3 * np.random.default_rng(n).normal(size=n))
    fit = fit_hyperbola(sigma, w)
    k, w_m = fit.k_ni.value, fit.w_m.value
    found = hyperbola(sigma, k, w_m)
    # d w / d ln k and d w / d ln w_m.
    slopes = np.column_stack([-k * found**2 / sigma, found - k * found**2 / sigma])
    variance = np.sum((w - found) ** 2) / (n - 2) * np.diag(np.linalg.inv(slopes.T @ slopes))
    half = stats.t.ppf(0.975, n - 2) * np.sqrt(variance)
    for one, by in zip((fit.k_ni, fit.w_m), half, strict=True):
        assert np.log([one.high / one.value, one.value / one.low]) == pytest.approx(by, rel=0.01)


def test_a_semi_logarithmic_curve_is_found_again_exactly():
    fit = fit_semi_logarithmic(PRESSURE, 0.2 + 0.05 * np.log(PRESSURE))
    assert (fit.a.value, fit.b.value) == pytest.approx((0.2, 0.05), rel=1e-9)
    assert (fit.b.low, fit.b.high) == pytest.approx((0.05, 0.05), rel=1e-6)
    assert fit.misfit < 1e-9
    assert (fit.n, fit.reason) == (8, "")


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_laws_do_not_depend_on_the_unit_of_length(unit):
    w = hyperbola(PRESSURE) * (1 + 0.02 * np.cos(PRESSURE))
    one, other = fit_hyperbola(PRESSURE, w), fit_hyperbola(PRESSURE, unit * w)
    assert other.k_ni.value * unit == pytest.approx(one.k_ni.value, rel=1e-4)
    one, other = (fit_semi_logarithmic(PRESSURE, x) for x in (w, unit * w))
    assert other.b.value == pytest.approx(unit * one.b.value)
    assert other.misfit == pytest.approx(one.misfit)


def test_the_intervals_hold_the_truth_in_95_of_100_draws():
    rng = np.random.default_rng(1)
    w = np.linspace(0.02, 0.35, 12)
    sigma = 30 * w / (1 - w / 0.4)
    draws = ensemble("fitted hyperbolas")
    fits = [fit_hyperbola(sigma, w + rng.normal(0, 0.004, w.size)) for _ in range(draws)]
    held = [
        sum(fit.k_ni.low <= 30 <= fit.k_ni.high for fit in fits),
        sum(fit.w_m.low <= 0.4 <= fit.w_m.high for fit in fits),
    ]
    w = 0.2 + 0.05 * np.log(sigma)
    logs = [fit_semi_logarithmic(sigma, w + rng.normal(0, 0.004, w.size)) for _ in range(draws)]
    held += [
        sum(fit.a.low <= 0.2 <= fit.a.high for fit in logs),
        sum(fit.b.low <= 0.05 <= fit.b.high for fit in logs),
    ]
    # At most three standard deviations of the count below: 930 of 1000.
    assert min(held) >= 0.95 * draws - 3 * np.sqrt(0.95 * 0.05 * draws), held


def test_a_straight_line_has_no_asymptote():
    sigma = np.linspace(1, 10, 8)
    fit = fit_hyperbola(sigma, sigma / 50 * (1 + 1e-3 * np.sin(sigma)))
    assert np.isnan(fit.w_m.value) or fit.w_m.high > 2 * sigma.max() / 50


def test_an_asymptote_that_is_open_by_more_than_a_factor_of_100_is_none():
    """With more scatter a curve of little bend loses its asymptote, and with it both constants."""
    sigma = np.linspace(1, 10, 8)
    scatter = np.cos(5 * sigma)
    fits = [
        fit_hyperbola(sigma, hyperbola(sigma, w_m=20.0) * (1 + noise * scatter))
        for noise in np.geomspace(0.01, 0.03, 120)
    ]
    known = [fit for fit in fits if not fit.reason]
    assert 0 < len(known) < len(fits)
    for fit in known:
        for constant in (fit.k_ni, fit.w_m):
            assert constant.high <= 100 * constant.value <= 1e4 * constant.low
    widest = max(fit.w_m.high / fit.w_m.value for fit in known)
    assert widest > 10
    for fit in fits:
        if fit.reason:
            assert fit.reason == "the points do not bend enough to show an asymptote"
            assert np.isnan([*fit.k_ni.ends, *fit.w_m.ends]).all()


def test_too_few_points_give_a_reason():
    for fit in (fit_hyperbola, fit_semi_logarithmic):
        found = fit([1, 2, 3], [0.1, 0.15, -1])
        parameters = [value for value in vars(found).values() if isinstance(value, Estimate)]
        assert len(parameters) == 2
        assert np.isnan([parameter.ends for parameter in parameters]).all()
        assert "2 points with w_int > 0, 4 needed" in found.reason
    assert law_of([1, 2, 3], [0.1, 0.15, -1]).name == ""


@pytest.mark.parametrize("fit", [fit_hyperbola, fit_semi_logarithmic])
def test_states_without_pressure_or_closure_are_not_fitted(fit):
    closure = hyperbola(PRESSURE)
    for pressure, closed in ((0, 1e-3), (0.1, 0)):
        assert fit(np.r_[pressure, PRESSURE], np.r_[closed, closure]) == fit(PRESSURE, closure)


# -- which law is named ----------------------------------------------------------------------------


def test_the_law_that_made_a_curve_is_named():
    assert law_of(PRESSURE, hyperbola(PRESSURE)) == (HYPERBOLA, "")
    assert law_of(PRESSURE, 0.3 + 0.05 * np.log(PRESSURE)) == (SEMI_LOGARITHMIC, "")


def test_scatter_hides_the_law_but_names_no_wrong_one():
    rng = np.random.default_rng(3)
    for made, other in ((hyperbola(PRESSURE), SEMI_LOGARITHMIC),):
        named = [law_of(PRESSURE, made * rng.normal(1, 0.01, 8)).name for _ in range(50)]
        assert named.count(other) == 0
    w = 0.3 + 0.05 * np.log(PRESSURE)
    named = [law_of(PRESSURE, w * rng.normal(1, 0.01, 8)).name for _ in range(50)]
    assert HYPERBOLA not in named
    assert named.count(SEMI_LOGARITHMIC) > 45


def test_a_curve_of_neither_law_says_how_far_off_the_better_is():
    law = law_of(PRESSURE, PRESSURE**0.7)
    assert law.name == NEITHER
    assert "% rms" in law.reason


def test_like_misfits_decide_nothing():
    fits = fit_hyperbola(PRESSURE, hyperbola(PRESSURE)), fit_semi_logarithmic(PRESSURE, PRESSURE)
    for misfits, name in (
        ((0.01, 0.0101), UNDECIDED),
        ((0.01, 0.0112), HYPERBOLA),
        ((0.015, 0.01), SEMI_LOGARITHMIC),
        ((np.nan, 0.01), SEMI_LOGARITHMIC),
        ((GOOD_FIT, 0.03), HYPERBOLA),
        ((0.021, 0.03), NEITHER),
    ):
        pair = (replace(fit, misfit=misfit) for fit, misfit in zip(fits, misfits, strict=True))
        assert better_law(*pair).name == name, misfits


@pytest.mark.parametrize(
    ("misfits", "name", "words"),
    [
        ((0.01, 0.03), HYPERBOLA, ""),
        ((0.01, 0.0101), UNDECIDED, ""),
        (
            (0.015, 0.01),
            SEMI_LOGARITHMIC,
            "by 1.5 % rms of the largest closure, a logarithm less",
        ),
        ((0.058, 0.07), NEITHER, "the hyperbola misses the curve by 5.8 % rms"),
    ],
)
def test_k_ni_is_undetermined_where_the_hyperbola_is_not_the_law(misfits, name, words):
    fits = fit_hyperbola(PRESSURE, hyperbola(PRESSURE)), fit_semi_logarithmic(PRESSURE, PRESSURE)
    fits = [replace(fit, misfit=misfit) for fit, misfit in zip(fits, misfits, strict=True)]
    law = better_law(*fits)
    assert law.name == name
    k_ni = fits[0].k_ni.value
    known = replace(fits[0], k_ni=Estimate(k_ni, 0.9 * k_ni, 1.1 * k_ni))
    why = undetermined_stiffness(known, law)
    assert bool(why) == bool(words)
    assert words in why
    # Nor is it determined by the best of laws where its interval spans decades.
    wide = replace(known, k_ni=Estimate(k_ni, k_ni / 20, 20 * k_ni))
    assert undetermined_stiffness(wide, law)


def test_k_ni_without_a_fit_has_the_reason_of_the_fit():
    none = fit_hyperbola([1, 2, 3], [0.1, 0.15, -1])
    assert undetermined_stiffness(none, law_of([1, 2, 3], [0.1, 0.15, -1])) == none.reason


# -- into the stage --------------------------------------------------------------------------------


def made_curves(nodes, closures, resolutions=(1,)):
    """A closure stage before its laws, over (direction, offset, resolution, load)."""
    dims = ("direction", "offset", "resolution", "normal_force")
    shape = (1, 1, len(resolutions), len(PRESSURE))
    return xr.Dataset(
        {
            "interface_closure": (dims, np.reshape(closures, shape)),
            "resolved": (dims, np.broadcast_to(np.asarray(nodes) >= 10, shape)),
            "suspect_load_share": (dims, np.zeros(shape)),
            "nominal_pressure": ("normal_force", PRESSURE),
        },
        coords={
            "direction": ["E"],
            "offset": [0.1],
            "resolution": list(resolutions),
            "normal_force": 100 * PRESSURE,
        },
    )


def test_states_of_few_nodes_are_not_fitted():
    # One node carries the light loads: its curve is its own, not that of the joint.
    nodes = np.array([1, 1, 9, 10, 30, 90, 200, 500])
    w = 0.3 + 0.05 * np.log(PRESSURE)
    w[:3] = 0.01
    curves = made_curves(nodes, w)
    add_closure_laws(curves, None)
    found = curves.squeeze()
    assert found["semi_logarithmic_b"].item() == pytest.approx(0.05)
    assert found["semi_logarithmic_n"] == found["hyperbola_n"] == 5
    assert found["closure_law"].item() == SEMI_LOGARITHMIC
    assert found["closure_fit_min"].item() == pytest.approx(100 * PRESSURE[3])
    assert found["closure_fit_max"].item() == pytest.approx(100 * PRESSURE[-1])
    curves = made_curves(np.where(nodes > 30, nodes, 3), w)
    add_closure_laws(curves, None)
    assert curves["closure_law"].item() == ""


@pytest.mark.parametrize(
    ("nodes", "closing", "fit_range", "words"),
    [
        # The closures of all are known: nodes are what is wanting.
        ([3] * 5 + [10, 20, 30], 8, None, "10 nodes touch in 3 of 8 states"),
        ([50] * 8, 8, (1, 2), "2 of 8 states lie in hyperbola_range"),
        ([50] * 8, 4, (1, 2), "2 of 4 states lie in hyperbola_range"),
        ([3] * 8, 4, None, "10 nodes touch in 0 of 4 states"),
        ([50] * 8, 3, None, "3 points with w_int > 0"),
    ],
)
def test_why_there_is_no_law_names_what_is_wanting_and_what_helps(nodes, closing, fit_range, words):
    w = np.where(np.arange(8) < closing, 0.3 + 0.05 * np.log(PRESSURE), 0.0)
    curves = made_curves(np.array(nodes), w)
    limits = None if fit_range is None else tuple(100 * PRESSURE[list(fit_range)])
    add_closure_laws(curves, limits)
    for law in ("hyperbola_reason", "semi_logarithmic_reason", "closure_law_reason"):
        why = curves[law].item()
        assert why.startswith(f"{words}, 4 needed")
        for cause, help_ in (("nodes", "heavier loads"), ("hyperbola_range", "widen")):
            assert (help_ in why) == (cause in why)


def test_the_stage_says_of_every_k_ni_whether_it_is_determined():
    closures = [hyperbola(PRESSURE) * (1 + 0.002 * np.cos(PRESSURE)), 0.3 + 0.05 * np.log(PRESSURE)]
    curves = made_curves(np.full(8, 50), closures, resolutions=(1, 4))
    add_closure_laws(curves, None)
    assert curves["closure_law"].values.ravel().tolist() == [HYPERBOLA, SEMI_LOGARITHMIC]
    assert curves["hyperbola_k_ni_determined"].values.ravel().tolist() == [True, False]
    reasons = curves["hyperbola_k_ni_reason"].values.ravel().tolist()
    assert [bool(reason) for reason in reasons] == [False, True]


@pytest.mark.parametrize("last", [4, 5])
def test_the_range_of_the_study_is_that_of_both_laws(last):
    """From four states on, which are enough."""
    curves = made_curves(np.full(8, 50), 0.3 + 0.05 * np.log(PRESSURE))
    add_closure_laws(curves, (100 * PRESSURE[1], 100 * PRESSURE[last]))
    assert curves["hyperbola_n"].item() == curves["semi_logarithmic_n"].item() == last
    assert curves["semi_logarithmic_reason"].item() == ""
    assert curves["closure_law"].item() == SEMI_LOGARITHMIC


def test_change_of_k_ni_is_that_from_twice_the_spacing():
    closures = [hyperbola(PRESSURE, k) for k in (10.0, 25.0, 40.0)]
    curves = made_curves(np.full(8, 50), closures, resolutions=(1, 2, 8))
    add_closure_laws(curves, None)
    change = curves["hyperbola_k_ni_change"].squeeze()
    assert change[0].item() == pytest.approx(1.5, rel=1e-5)
    assert np.isnan(change[1:]).all()


@pytest.mark.parametrize(("lightest", "softer"), [(1.0, False), (2.0, True)])
def test_a_curve_below_its_hyperbola_at_light_load_is_softer_than_its_k_ni(lightest, softer):
    """A hyperbola is nowhere softer than its k_ni; twice its closure at the lightest load is."""
    closure = hyperbola(PRESSURE)
    closure[0] *= lightest
    curves = made_curves(np.r_[1, np.full(7, 50)], closure)  # that load is not fitted
    add_closure_laws(curves, None)
    assert curves["hyperbola_k_ni"].item() == pytest.approx(30, rel=1e-5)
    assert curves["softer_than_k_ni"].item() == softer


def test_the_change_of_a_value_is_known_where_twice_the_spacing_was_solved():
    dims = {"resolution": [1, 2, 8], "normal_force": [1.0, 10.0]}
    values = xr.DataArray([[1.0, 4.0], [2.0, 3.0], [5.0, np.nan]], dims)
    change = at_twice(values)
    assert change.dims == values.dims
    np.testing.assert_allclose(change, [[1.0, -0.25], [np.nan] * 2, [np.nan] * 2])
