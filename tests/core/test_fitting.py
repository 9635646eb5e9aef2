import numpy as np
import pytest
from scipy import stats

from fractalcontact.core.fitting import fit_line


def test_points_on_a_line_give_it_back_without_error():
    x = np.array([0.0, 1.0, 2.0, 5.0])
    line = fit_line(x, 3 - 2 * x)
    assert line.slope.value == pytest.approx(-2)
    assert line.intercept.value == pytest.approx(3)
    assert line.slope.high - line.slope.low == pytest.approx(0, abs=1e-12)
    assert (*line.slope.over, line.n, line.r2) == (0, 5, 4, pytest.approx(1))


def test_intervals_agree_with_scipy():
    rng = np.random.default_rng(3)
    x = rng.random(9)
    y = 2 * x + rng.standard_normal(9)
    line, other = fit_line(x, y), stats.linregress(x, y)
    quantile = stats.t.ppf(0.975, 7)
    assert line.slope.value == pytest.approx(other.slope)
    assert line.slope.high - line.slope.value == pytest.approx(quantile * other.stderr)
    assert line.intercept.value - line.intercept.low == pytest.approx(
        quantile * other.intercept_stderr
    )
    assert line.r2 == pytest.approx(other.rvalue**2)


def test_interval_holds_the_true_slope_in_95_of_100_samples():
    rng = np.random.default_rng(0)
    x = np.arange(8.0)
    held = 0
    for _ in range(2000):
        line = fit_line(x, 0.5 * x + rng.standard_normal(8))
        held += line.slope.low <= 0.5 <= line.slope.high
    assert held / 2000 == pytest.approx(0.95, abs=0.015)


@pytest.mark.parametrize(
    ("x", "y", "n"),
    [([1, 2], [1, 2], 2), ([1, 2, np.nan], [1, 2, 3], 2), ([2, 2, 2], [1, 2, 3], 3), ([], [], 0)],
)
def test_no_line_without_three_points_at_two_places(x, y, n):
    line = fit_line(x, y)
    assert line.n == n
    assert np.isnan([*line.slope.ends, *line.intercept.ends, *line.slope.over, line.r2]).all()
