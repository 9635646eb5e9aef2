"""Estimates: in memory, as variables and columns, and in words."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fractalcontact.core.estimate import (
    DIMENSION,
    EXPONENT,
    SIZE,
    Estimate,
    names_of,
    rows_of,
)
from fractalcontact.core.limits import CONFIDENCE

SEVERAL = Estimate(
    np.array([[1.0, 2.0], [3.0, np.nan]]), np.array([[0.5, 1.0], [2.0, np.nan]]), np.full((2, 2), 9)
)


def test_what_is_written_is_read_again():
    written = xr.Dataset(SEVERAL.variables("k", ("offset", "load"), "MPa/mm", "stiffness"))
    assert list(written) == names_of("k") == list(rows_of("k", "MPa/mm", "stiffness"))
    for found in (Estimate.read(written, "k"), Estimate.read(SEVERAL.columns("k"), "k")):
        np.testing.assert_array_equal(found.ends, SEVERAL.ends)
    row = pd.DataFrame(SEVERAL[0].columns("k")).iloc[1]
    assert Estimate.read(row, "k").ends == (2.0, 1.0, 9.0)


def test_variables_and_tables_of_variables_say_the_same_of_themselves():
    written = xr.Dataset(SEVERAL.variables("k", ("offset", "load"), "MPa/mm", "stiffness"))
    for name, (units, long_name) in rows_of("k", "MPa/mm", "stiffness").items():
        assert written[name].attrs == {"units": units, "long_name": long_name}
    for end in ("k_low", "k_high"):
        assert f"{100 * CONFIDENCE:g} %" in written[end].attrs["long_name"]


def test_a_column_ends_in_its_unit():
    assert list(Estimate(1, 0, 2).columns("k_ni", "MPa/mm")) == [
        "k_ni_MPa_per_mm",
        "k_ni_low_MPa_per_mm",
        "k_ni_high_MPa_per_mm",
    ]


@pytest.mark.parametrize("unit", ["", "1"])
def test_a_column_without_a_unit_ends_in_its_name(unit):
    assert list(Estimate(1, 0, 2).columns("m", unit)) == ["m", "m_low", "m_high"]


def test_a_missing_end_is_an_error():
    with pytest.raises(KeyError, match="k_high"):
        Estimate.read({"k": 1.0, "k_low": 0.5}, "k")


def test_an_interval_about_a_value_keeps_within_the_bounds_of_the_quantity():
    found = Estimate.about(np.array([0.001, 0.5, 0.99, 1.0000001]), 0.02, 0.0, 1.0)
    np.testing.assert_allclose(found.low, [0.0, 0.48, 0.97, 0.98], atol=1e-6)
    np.testing.assert_allclose(found.high, [0.021, 0.52, 1.0, 1.0], atol=1e-6)
    assert (found.low <= found.value).all()
    assert (found.value <= found.high).all()
    assert Estimate.about(-0.5, 1.0).ends == (-0.5, -1.5, 0.5)
    assert np.isnan(Estimate.about(0.5, np.nan, 0.0).ends[1:]).all()


def test_a_quantity_keeps_within_its_bounds():
    beyond = Estimate(np.array([-0.1, 1.0]), np.array([-0.5, 0.5]), np.array([0.3, 2.5]))
    np.testing.assert_array_equal(beyond.in_plane().ends, [[0, 1], [0, 0.5], [0.3, 2]])
    np.testing.assert_array_equal(beyond.within(0, np.inf).ends, [[0, 1], [0, 0.5], [0.3, 2.5]])
    np.testing.assert_array_equal(beyond.width, [0.8, 2])


def test_a_falling_function_exchanges_the_ends():
    rising, falling = (
        SEVERAL.mapped(np.log),
        SEVERAL.mapped(lambda x: 3 - x, falling=True),
    )
    for found in (rising, falling):
        known = found.known
        assert (found.low[known] <= found.value[known]).all()
        assert (found.value[known] <= found.high[known]).all()
    np.testing.assert_array_equal(falling.low, 3 - SEVERAL.high)


def test_estimates_are_stacked_in_the_order_of_an_array_and_taken_apart_again():
    each = [Estimate(i, i - 1, i + 1, n=i, over=(i, 2 * i), reason=str(i)) for i in range(6)]
    together = Estimate.stack(each, (2, 3))
    assert together[1, 2] == each[5]
    np.testing.assert_array_equal(together.over[1], [[0, 2, 4], [6, 8, 10]])
    shared = Estimate(np.arange(3), 0, 9, n=7, over=(1, 2), reason="few", scale=EXPONENT)
    assert shared[2] == Estimate(2, 0, 9, n=7, over=(1, 2), reason="few", scale=EXPONENT)
    rows = Estimate.stack([SEVERAL[0], SEVERAL[1]], (2, 2))
    np.testing.assert_array_equal(rows.ends, SEVERAL.ends)
    assert rows.n.shape == rows.reason.shape == (2, 2)


@pytest.mark.parametrize(
    ("ends", "scale", "says"),
    [
        ((1.0, 0.5, 2.0), SIZE, True),
        ((1.0, 0.1, 20.0), SIZE, False),  # more than a decade
        ((0.1, -0.3, 0.5), SIZE, True),
        ((0.1, -0.3, 0.5), EXPONENT, True),
        ((0.1, -0.6, 0.8), EXPONENT, False),  # wider than 1, and of either sign
        ((1.2, 0.1, 2.0), DIMENSION, True),
        ((1.2, -0.4, 2.8), DIMENSION, False),  # wider than all that a set in the plane can have
        ((2.0, 2.0, 2.0), DIMENSION, True),  # a full window
        ((1.2, 1.2, 1.2), DIMENSION, False),  # an error left out
        ((1.0, np.nan, np.nan), SIZE, False),
    ],
)
def test_whether_an_interval_determines_depends_on_the_kind_of_quantity(ends, scale, says):
    assert Estimate(*ends, scale=scale).determined is says


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        ((0.96, 0.02, 1.9), "undetermined (0.96 ± 0.94)"),
        ((1.45, -0.34, 3.24), "undetermined (1.45 ± 1.79)"),
        ((0.9, 0.3, 1.9), "undetermined (0.90 [0.30, 1.90])"),
        ((400, -1e4, 9e3), "undetermined (400 [-10000, 9000])"),
        ((-1e-9, -1, 1), "undetermined (0.00 ± 1.00)"),
        ((1.0, 1.0 - 1e-14, 1.0 + 1e-14), "undetermined (1, error not known)"),
        ((0.5, np.nan, np.nan), "undetermined (0.5, error not known)"),
        ((0.5, -np.inf, np.inf), "undetermined (0.5, error not known)"),
        ((np.nan, np.nan, np.nan), "undetermined"),
    ],
)
def test_what_is_undetermined_has_its_value_and_error(ends, words):
    assert Estimate(*ends).undetermined() == words


def test_rounding_is_no_digit_of_a_dimension():
    slope = Estimate(-2.2e-16, np.nan, np.nan, scale=DIMENSION)
    assert slope.text() == "undetermined (0.00, error not known)"


def test_error_has_two_digits_however_small_or_large():
    for size in 10.0 ** np.arange(-6, 7):
        words = Estimate(3 * size, -1.1 * size, 7.1 * size).undetermined()
        value, error = (float(part) for part in words.split("(")[1].rstrip(")").split(" ± "))
        assert value == pytest.approx(3 * size, rel=0.02)
        assert error == pytest.approx(4.1 * size, rel=0.02)


@pytest.mark.parametrize(
    ("ends", "scale", "unit", "words"),
    [
        ((0.96, -0.14, 2.06), DIMENSION, "", "undetermined (0.96 ± 1.10)"),
        ((3.0, -40, 46), SIZE, "mm", "undetermined (3 ± 43 mm)"),
        ((0.96, 0.9, 1.02), DIMENSION, "", "0.96 [0.90, 1.02]"),
        ((-1e-12, -0.004, 0.3), DIMENSION, "", "0.00 [0.00, 0.30]"),
        ((12.34, 10, 20), SIZE, "MPa/mm", "12.3 [10, 20] MPa/mm"),
        ((np.nan, 0, 1), SIZE, "mm", "no fit"),
        ((np.nan, 0, 1), DIMENSION, "", "undetermined"),
    ],
)
def test_an_estimate_in_words(ends, scale, unit, words):
    assert Estimate(*ends, scale=scale).text(unit) == words
