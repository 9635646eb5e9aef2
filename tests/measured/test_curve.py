"""Errors of curves, of their ratio and of a fitted constant, by exact cases."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.settings import MeasuredTest
from fractalcontact.measured.calibration import fit_factor
from fractalcontact.measured.computed import Joint
from fractalcontact.measured.curve import Curve, ratio


def test_values_counted_from_a_point_have_the_errors_of_both_ends():
    curve = Curve.of([1.0, 2.0, 4.0, 8.0], [0.0, 1.0, 2.0, 3.0], [0.3, 0.3, 0.3, 0.4])
    counted = curve.since(2.0)
    np.testing.assert_array_equal(counted.x, [2, 4, 8])
    np.testing.assert_allclose(counted.y, [0, 1, 2], atol=1e-12)
    np.testing.assert_allclose(counted.error, np.hypot([0.3, 0.3, 0.4], 0.3))


def test_a_value_between_points_has_the_larger_error_of_both():
    curve = Curve.of([1.0, 2.0, 4.0], [0.0, 1.0, 2.0], [0.2, 0.3, 0.4])
    found = curve.at(np.array([0.5, 2**0.5, 2**1.5, 5.0]))
    np.testing.assert_allclose(found.value, [np.nan, 0.5, 1.5, np.nan])
    np.testing.assert_allclose(found.value - found.low, [np.nan, 0.3, 0.4, np.nan])
    np.testing.assert_allclose(found.high - found.value, [np.nan, 0.3, 0.4, np.nan])


def test_a_ratio_is_lowest_where_its_divisor_is_highest():
    found = ratio(Estimate(1.0, 0.8, 1.3), Estimate(2.0, 1.0, 3.0))
    assert found.value == 0.5
    assert found.low == pytest.approx(0.5 * np.exp(-np.hypot(np.log(0.8), np.log(3 / 2))))
    assert found.high == pytest.approx(0.5 * np.exp(np.hypot(np.log(1.3), np.log(2))))


def test_the_interval_of_a_factor_is_that_of_the_slope_of_a_line():
    # Closure as the factor times ln x, from a datum that is fitted too: linear regression.
    x = np.geomspace(1, 20, 14)
    noise = 0.02 * np.random.default_rng(2).normal(size=x.size)
    line = stats.linregress(np.log(x), 0.1 + 1.2 * np.log(x) + noise)
    readings = Curve.of(x, 0.1 + 1.2 * np.log(x) + noise, 0.0)
    dense = np.geomspace(0.9, 22, 400)
    found = fit_factor(readings, lambda f: Curve.of(dense, f * np.log(dense), 0.0), (1 / 3, 3))
    half = stats.t.ppf(0.975, x.size - 2) * line.stderr
    assert found.value == pytest.approx(line.slope, rel=1e-4)
    assert found.value - found.low == pytest.approx(half, rel=0.03)
    assert found.high - found.value == pytest.approx(half, rel=0.03)


def joint_of(hardness, windows=0.0, hardest=0.8):
    """A joint whose closure is 10 um for each e-fold of pressure; less by a factor if harder."""
    pressure = np.geomspace(0.25, 25, 9)
    closure = 0.01 * np.log(pressure / 0.25) + 0.1
    curve = Curve.of(pressure, closure, 0.0)
    loading = SimpleNamespace(solving={"hardness": hardness})
    harder = Curve.of(pressure, hardest * closure, 0.0)
    return Joint(loading, 1, curve, 0.1, np.full(9, windows), harder)


def test_computed_closure_carries_the_range_over_hardness_modulus_and_windows():
    test = MeasuredTest("closure", "load.csv", {}, branch="load")
    since = joint_of(np.inf).curve.since(0.25)
    # A straight line over ln(pressure) has one closure from its datum at every modulus.
    elastic = joint_of(np.inf).apart(test, 25.0, 0.25, since)
    np.testing.assert_allclose(elastic, 0, atol=1e-12)
    crushing = joint_of(80.0).apart(test, 25.0, 0.25, since)
    np.testing.assert_allclose(crushing, 0.2 * since.y, atol=1e-12)
    windows = joint_of(np.inf, windows=0.003).apart(test, 25.0, 0.25, since)
    np.testing.assert_allclose(windows, 0.003 * np.sqrt(2))
    both = joint_of(80.0, windows=0.003).apart(test, 25.0, 0.25, since)
    np.testing.assert_allclose(both, np.hypot(crushing, windows))
    bent = Curve.of(since.x, 0.01 * np.sqrt(since.x), 0.0)
    of_modulus = joint_of(np.inf).apart(test, 25.0, 0.25, bent)
    assert of_modulus[-1] == pytest.approx(0.1 * 0.5 * (bent.y[-1] - bent.y[0]), rel=0.2)
