"""Means and their t-intervals; the jackknife is tested with the slopes it serves."""

import numpy as np
import pytest
from scipy import stats

from fractalcontact.core.intervals import mean_difference, mean_interval, t_quantile
from fractalcontact.core.limits import CONFIDENCE


def test_the_quantile_is_student_s():
    freedom = np.array([1, 2, 5, 30, 10_000])
    np.testing.assert_allclose(t_quantile(freedom), stats.t.ppf((1 + CONFIDENCE) / 2, freedom))
    assert t_quantile(10**9) == pytest.approx(1.959964, abs=1e-6)


def test_a_mean_has_the_t_interval_of_its_values_along_either_axis():
    values = np.random.default_rng(1).normal(3, 2, size=(6, 4))
    for axis in (0, 1):
        mean = mean_interval(values, axis=axis)
        n = values.shape[axis]
        low, high = stats.t.interval(
            CONFIDENCE, n - 1, values.mean(axis=axis), stats.sem(values, axis=axis)
        )
        np.testing.assert_allclose(mean.value, values.mean(axis=axis))
        np.testing.assert_allclose(mean.low, low)
        np.testing.assert_allclose(mean.high, high)
        assert (mean.n == n).all()


def test_missing_values_are_left_out():
    values = np.array([[1.0, np.nan, np.nan], [2.0, 5.0, np.nan], [np.nan, np.nan, np.nan]])
    mean = mean_interval(values, axis=0)
    assert mean.n.tolist() == [2, 1, 0]
    np.testing.assert_array_equal(mean.value, [1.5, 5.0, np.nan])
    assert np.isfinite(mean.low).tolist() == [True, False, False]
    assert mean.high[0] - 1.5 == pytest.approx(1.5 - mean.low[0])


def test_the_interval_holds_the_mean_as_often_as_it_says():
    values = np.random.default_rng(2).normal(size=(5, 4000))
    mean = mean_interval(values)
    assert np.mean((mean.low <= 0) & (mean.high >= 0)) == pytest.approx(CONFIDENCE, abs=0.015)


def test_a_difference_of_means_has_student_s_interval():
    found = mean_difference([1.0, 2.0, 3.0], [4.0, 7.0])
    half = t_quantile(3) * np.sqrt((2 + 4.5) / 3 * (1 / 3 + 1 / 2))
    assert found.value == pytest.approx(2 - 5.5)
    assert found.ends[1:] == pytest.approx((-3.5 - half, -3.5 + half))
    assert np.isnan(mean_difference([1.0], [2.0]).width)


def test_the_interval_of_a_difference_holds_it_as_often_as_it_says():
    rng = np.random.default_rng(1)
    held = [
        one.low <= 1 <= one.high
        for one in (mean_difference(rng.normal(1, 1, 4), rng.normal(0, 1, 2)) for _ in range(3000))
    ]
    assert np.mean(held) == pytest.approx(0.95, abs=0.012)
