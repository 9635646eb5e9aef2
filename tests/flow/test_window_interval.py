"""Window interval of the transmissivity: coverage, and what leaves it undetermined."""

import numpy as np
import pytest
from ensembles import ensemble
from scipy import ndimage

from fractalcontact.flow.cubic_law import flow_of, window_interval

STEP = (1.0, 1.0)


def gap_of(seed, n=64, smooth=1.5, mean=1.5):
    """One window of a field of filtered noise, in contact over 7 %."""
    noise = np.random.default_rng(seed).normal(size=(n, n))
    heights = ndimage.gaussian_filter(noise, smooth, mode="wrap")
    return np.clip(heights * 2 * smooth * np.sqrt(np.pi) + mean, 0, None)


def test_the_interval_over_windows_holds_their_mean_as_often_as_it_says():
    gaps = [gap_of(seed) for seed in range(ensemble("windows of one field"))]
    flows = [flow_of(gap, STEP, "x").transmissivity for gap in gaps]
    mean = np.exp(np.log(flows).mean())
    both = zip(gaps, flows, strict=True)
    low, high = np.transpose([window_interval(gap, STEP, "x", T).ends[1:] for gap, T in both])
    share = ((low <= mean) & (mean <= high)).mean()
    assert 0.95 - 3 * np.sqrt(0.95 * 0.05 / len(gaps)) <= share


def test_an_even_gap_is_alike_in_all_windows():
    flow = flow_of(np.full((9, 12), 0.3), STEP, "y").transmissivity
    found = window_interval(np.full((9, 12), 0.3), STEP, "y", flow)
    assert found.ends == pytest.approx((flow, flow, flow))


def test_a_closed_quarter_leaves_the_interval_undetermined():
    gap = gap_of(1)
    gap[:32, 10] = 0  # a wall across two quarters
    whole = flow_of(gap, STEP, "x").transmissivity
    assert whole > 0
    assert np.isnan(window_interval(gap, STEP, "x", whole).ends[1:]).all()


def test_the_interval_is_student_s_of_four_quarters():
    gaps = np.array([[0.1, 0.2], [0.4, 0.1]])
    gap = np.kron(gaps, np.ones((6, 8)))
    spread = np.std(3 * np.log(gaps), ddof=1)
    found = window_interval(gap, (0.1, 0.1), "x", 1.0)
    assert found.high == pytest.approx(np.exp(3.182446 * spread / 2), rel=1e-5)
    assert found.low == pytest.approx(1 / found.high)


def test_the_error_of_the_mean_gap_enters_three_times_in_quadrature():
    gap = np.kron(np.array([[0.1, 0.2], [0.4, 0.1]]), np.ones((6, 8)))
    alone, both = (window_interval(gap, (0.1, 0.1), "x", 1.0, error) for error in (0.0, 0.2))
    expected = np.hypot(np.log(alone.high), 3 * 0.2)
    assert np.log(both.high) == pytest.approx(expected, rel=1e-12)
    assert both.low == pytest.approx(1 / both.high)
