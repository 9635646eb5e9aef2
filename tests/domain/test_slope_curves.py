"""Curves of local slopes of box counts: exact cases, and how often equals are called different."""

import numpy as np
import pytest
from ensembles import ensemble
from known_sets import cantor_dust, fractal_percolation, sierpinski_carpet, thinned

from fractalcontact.core.determined import differs
from fractalcontact.core.limits import MIN_NODES
from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.domain.null_models import bearing_area_cut, null_models
from fractalcontact.domain.random_nodes import expected_mean_counts
from fractalcontact.domain.slope_curves import (
    DRAWS,
    MIN_PARTS,
    SlopeCurve,
    curve_sizes,
    departure_from_draws,
    paired_departure,
    random_curves,
    slope_curve,
    window_counts,
)
from fractalcontact.surface.synthesis import self_affine


def scattered(shape, nodes, seed):
    return thinned(np.ones(shape, bool), nodes, [99, seed])


# -- exact -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", [(64, 64), (48, 100), (130, 27)])
def test_a_filled_window_has_slope_two_at_every_side(shape):
    filled = SlopeCurve(np.ones(shape, bool))
    assert filled.values.size == filled.sizes.size - 1 > 0
    np.testing.assert_allclose(filled.values, 2)


def test_all_that_was_measured_has_slope_two_at_every_side():
    mask = np.hypot(*np.mgrid[-40:41, -40:41]) < 39
    np.testing.assert_allclose(SlopeCurve(mask, mask).values, 2)


def test_axes_and_sides_of_the_window_may_be_swapped():
    domain = scattered((60, 110), 200, 0)
    curve = SlopeCurve(domain).values
    for other in (domain.T, domain[::-1], domain[:, ::-1]):
        np.testing.assert_allclose(SlopeCurve(other.copy()).values, curve)


def test_box_sides_double_from_the_smallest_fitted_to_a_third_of_the_window():
    assert curve_sizes((512, 200)).tolist() == [4, 8, 16, 32, 64]
    assert curve_sizes((96, 97)).tolist() == [4, 8, 16, 32]
    assert curve_sizes((11, 500)).size == 0


def test_one_of_equal_draws_is_called_different_with_the_stated_probability():
    draws = random_curves((48, 48), 40, draws=100)
    p = [departure_from_draws(draws[i], np.delete(draws, i, axis=0)).p for i in range(100)]
    assert sorted(p) == pytest.approx(np.arange(1, 101) / 100)


def test_a_domain_does_not_differ_from_itself():
    curve = SlopeCurve(scattered((64, 64), 200, 1))
    difference, departure = paired_departure(curve, curve)
    assert departure.p == 1
    assert not np.any(difference.ends)


def test_contact_in_too_few_parts_has_no_scatter():
    domain, other = np.zeros((2, 96, 96), bool)
    domain[2:8, 2:8], other[2:8, 3:9] = True, True
    assert (SlopeCurve(domain).occupied.size, MIN_PARTS) == (1, 4)
    difference, departure = paired_departure(SlopeCurve(domain), SlopeCurve(other))
    assert np.isnan([departure.p, *difference.low, *SlopeCurve(domain).interval.low]).all()


# -- independent -----------------------------------------------------------------------------------


def test_curves_of_random_nodes_are_those_of_their_expected_counts():
    shape, nodes = (72, 96), 90
    sizes = curve_sizes(shape)
    expected = expected_mean_counts(shape, nodes, sizes) / window_counts(shape, sizes)
    draws = random_curves(shape, nodes)
    error = draws.std(axis=0) / np.sqrt(DRAWS)
    # The slope of mean counts and the mean of slopes differ by the square of the scatter.
    bias = draws.std(axis=0) ** 2
    assert (np.abs(draws.mean(axis=0) - slope_curve(expected, sizes)) < 4 * error + bias).all()


def test_intervals_hold_the_local_slopes_of_the_whole():
    """Random nodes: their own scatter is known from draws, that of the jackknife from one."""
    shape, nodes = (96, 96), 150
    truth = random_curves(shape, nodes).mean(axis=0)
    found = [SlopeCurve(scattered(shape, nodes, seed)).interval for seed in range(200)]
    covered = [(one.low <= truth) & (truth <= one.high) for one in found]
    assert (np.mean(covered, axis=0) > 0.93).all()


# -- how often -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shape", "nodes"),
    [((64, 64), 40), ((128, 128), 300), ((60, 160), 100), ((200, 70), 900), ((200, 200), 305)],
)
def test_random_nodes_are_called_different_in_one_of_twenty_cases(shape, nodes):
    draws = random_curves(shape, nodes)
    p = [
        departure_from_draws(SlopeCurve(scattered(shape, nodes, seed)).values, draws).p
        for seed in range(ensemble("random domains compared"))
    ]
    assert 0.025 <= np.mean([differs(one) for one in p]) <= 0.08


def test_random_nodes_within_an_outline_are_called_different_as_rarely():
    mask = np.hypot(*np.mgrid[-48:49, -48:49]) < 48
    draws = random_curves(mask.shape, 120, mask)
    p = [
        departure_from_draws(SlopeCurve(thinned(mask, 120, seed), mask).values, draws).p
        for seed in range(ensemble("random domains compared"))
    ]
    assert 0.025 <= np.mean([differs(one) for one in p]) <= 0.08


@pytest.mark.parametrize(
    ("shape", "hurst", "roll_off", "unlike", "nodes"), ensemble("worlds of cuts")
)
def test_cuts_are_called_different_from_cuts_in_one_of_twenty_cases(
    shape, hurst, roll_off, unlike, nodes
):
    """Cuts of two surfaces that share hills, each with as much of its own: neither is special."""

    def surface(seed):
        return self_affine(shape, 1.0, hurst, rms=1.0, seed=seed, roll_off=roll_off)

    p = []
    for seed in range(0, 3 * ensemble("pairs of cuts"), 3):
        shared, *own = (surface(seed + i) for i in range(3))
        cuts = (SlopeCurve(bearing_area_cut(shared + unlike * one, nodes)) for one in own)
        p.append(paired_departure(*cuts)[1].p)
    assert 0.025 <= np.mean([differs(one) for one in p]) <= 0.08


FRACTALS = {
    "carpet": lambda seed: thinned(sierpinski_carpet(243), 400, seed),
    "dust": lambda seed: thinned(cantor_dust(243), 300, seed),
    "percolation": lambda seed: thinned(fractal_percolation(8, 0.75, seed), 300, seed),
}


@pytest.mark.parametrize("name", FRACTALS)
def test_sets_of_known_dimension_differ_from_random_at_a_few_hundred_nodes(name):
    for seed in range(ensemble("fractals beside nulls")):
        domain = FRACTALS[name](seed)
        draws = random_curves(domain.shape, int(domain.sum()))
        assert differs(departure_from_draws(SlopeCurve(domain).values, draws).p)


def test_one_fitted_slope_hides_a_fractal_that_the_curve_shows():
    """A fractal whose fitted dimension is that of as many random nodes, out of thirty."""
    candidates = [fractal_percolation(8, 0.5, seed) for seed in range(12)]
    candidates = [domain for domain in candidates if domain.sum() > 200]
    compared = null_models(np.array(candidates), 0.1)
    fitted = np.array([dimension_of_domain(domain, 0.1).dimension for domain in candidates])
    less = fitted - compared["delta_sigma_random"].values
    nearest = int(np.argmin(np.abs(less)))
    one = compared.isel(normal_force=nearest)
    low, high = (one[f"delta_sigma_random{end}"].item() for end in ("_low", "_high"))
    assert abs(less[nearest]) < 0.02
    assert low < fitted[nearest] < high
    assert one["null_verdict"].item() == "different from random nodes"


@pytest.mark.parametrize("seed", range(3))
def test_fewer_nodes_never_make_a_domain_more_determined(seed):
    whole = fractal_percolation(7, 0.75, seed)
    nodes = [2, 8, 15, MIN_NODES - 1, MIN_NODES, 60, 120, 300]
    compared = null_models(np.array([thinned(whole, n, seed) for n in nodes]), 0.1)
    determined = compared["null_verdict"].values != "undetermined"
    assert determined.tolist() == [n >= MIN_NODES for n in nodes]
    assert (np.isfinite(compared["local_slope_random_p"]) == determined).all()
    assert ((compared["null_reason"] == "") == determined).all()
