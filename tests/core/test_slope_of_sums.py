import numpy as np
import pytest

from fractalcontact.core.intervals import jackknife_error
from fractalcontact.core.slope_of_sums import slope_of_sums, wave_error


def test_jackknife_of_a_mean_is_its_t_interval():
    from scipy import stats

    x = np.random.default_rng(0).normal(size=16)
    left = (x.sum() - x) / 15
    expected = stats.sem(x) * stats.t.ppf(0.975, 15)
    assert jackknife_error(left) == pytest.approx(expected)


def test_jackknife_of_two_divisions_pools_them():
    from scipy import stats

    rows, columns = np.random.default_rng(0).normal(size=(2, 4))
    expected = np.sqrt((stats.sem(rows) ** 2 + stats.sem(columns) ** 2) / 2) * stats.t.ppf(0.975, 6)
    left = [(x.sum() - x) / 3 for x in (rows, columns)]
    assert jackknife_error(*left) == pytest.approx(expected)
    assert jackknife_error(left[0], [1.0]) == pytest.approx(jackknife_error(left[0]))


def test_jackknife_with_too_little():
    assert jackknife_error([]) == 0
    assert jackknife_error([1.0]) == 0
    assert jackknife_error([1.0, np.nan]) == np.inf


def test_smooth_bend_is_no_wave():
    scales = np.geomspace(1, 100, 20)
    x = np.log(scales)
    assert wave_error(scales, 3 - x + 0.2 * x**2) == pytest.approx(0, abs=1e-12)
    # A wave of amplitude a over the range tilts a line by at most 4 a / range.
    wave = 0.1 * np.sin(2 * np.pi * x * 3 / x[-1])
    assert wave_error(scales, x**2 + wave) == pytest.approx(2 * 0.1 / x[-1], rel=0.2)
    assert wave_error(scales[:3], np.array([0.0, 1.0, 0.0])) == 0


def test_interval_covers_the_slope_of_independent_parts():
    scales = 2.0 ** np.arange(8)
    rng = np.random.default_rng(1)
    covered = []
    for _ in range(200):
        # Parts with a slope of their own: their scatter is in no regression. With twice of it, sums
        # of 16 parts are so skew that the jackknife alone covers 89 %.
        parts = scales[:, None] ** (-1.5 + 0.1 * rng.standard_normal(16))
        found = slope_of_sums(scales, parts[:, None], lambda sums: sums[:, 0])
        truth = slope_of_sums(scales, _expected(scales)[:, None, None], lambda sums: sums[:, 0])
        covered.append(found.low <= truth.value <= found.high)
    assert np.mean(covered) >= 0.92


def _expected(scales):
    return scales**-1.5 * np.exp(0.5 * (0.1 * np.log(scales)) ** 2)


def test_scales_without_a_value_are_left_out():
    scales = np.arange(1.0, 9)
    parts = (scales**-1.0)[:, None, None].repeat(3, axis=2)
    parts[0] = 0
    found = slope_of_sums(scales, parts, lambda sums: sums[:, 0])
    assert found.value == pytest.approx(-1)
    assert (found.over[0], found.n) == (2, 7)
    parts[:5] = 0
    none = slope_of_sums(scales, parts, lambda sums: sums[:, 0])
    assert np.isnan(none.value)
    assert none.n == 0
