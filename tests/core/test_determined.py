"""Which intervals say something of their quantity."""

import numpy as np
import pytest

from fractalcontact.core.determined import determined, differ_together


@pytest.mark.parametrize(
    ("estimate", "how", "expected"),
    [
        ((452.0, 440.0, 470.0), {}, True),
        ((9.4, 8.9, 9.9), {}, True),
        ((6.6, 3.3, 13.1), {}, True),
        ((211.9, 49.1, 914.0), {}, False),  # more than a decade
        ((-3.0, -9.0, -1.0), {}, True),
        ((-3.0, -11.0, -1.0), {}, False),
        ((1.51, -37.0, 40.0), {"span": 30.0}, False),  # an angle
        ((-0.1, -2.2, 1.4), {"span": 30.0}, True),
        ((-0.223, -2.79, 2.34), {"span": 1.0}, False),  # an exponent
        ((3.0, 1.9, 4.1), {"span": 1.0}, True),
        ((0.92, 0.14, 2.00), {"span": 2.0}, True),  # a dimension, of 0 to 2
        ((0.92, -0.4, 2.4), {"span": 2.0}, False),
        ((0.05, 0.0, 0.4), {"span": 1.0}, True),
        ((0.07, -0.06, 0.20), {}, True),
        ((0.01, -0.06, 0.20), {}, False),
        ((1.0, 1.0, 1.0), {"span": 1.0}, False),  # three counts on a line
        ((1e-9, 9e-10, 1.1e-9), {"span": 1.0}, False),  # a line that is level but for rounding
        ((2.0, 2.0, 2.0), {"span": 1.0, "exact": (0.0, 2.0)}, True),
        ((0.0, 0.0, 0.0), {"span": 1.0, "exact": (0.0, 2.0)}, True),
        ((1.0, np.nan, np.nan), {"span": 1.0}, False),
        ((np.nan, 0.1, 0.2), {"span": 1.0}, False),
        ((1.0, 0.5, np.inf), {}, False),
    ],
)
def test_an_interval_determines_its_quantity_or_not(estimate, how, expected):
    assert determined(*estimate, **how) == expected


def test_neither_sign_nor_unit_matter():
    rng = np.random.default_rng(1)
    seen = set()
    for low, width, part in zip(
        rng.normal(0, 3, 200), rng.exponential(8, 200), rng.random(200), strict=True
    ):
        value, high = low + part * width, low + width
        verdict = determined(value, low, high)
        seen.add(verdict)
        assert determined(-value, -high, -low) == verdict
        assert determined(1e-3 * value, 1e-3 * low, 1e-3 * high) == verdict
        if verdict:
            assert determined(value, low + 0.4 * part * width, high) or low * high < 0
    assert seen == {True, False}


@pytest.mark.parametrize(
    ("p", "expected"),
    [
        ([0.04], [True]),
        # Two of 0.04: one of them is below 5 % by chance in 8 of 100 cases.
        ([0.04, 0.04], [False, False]),
        ([0.02, 0.04], [True, True]),
        ([0.04, np.nan, 0.02], [True, False, True]),
        # After the first that is not significant none is.
        ([0.001, 0.03, 0.04], [True, False, False]),
        ([], []),
    ],
)
def test_departures_tested_together_by_holm(p, expected):
    assert differ_together(p).tolist() == expected


def test_holm_calls_one_of_many_different_in_five_of_a_hundred_cases():
    p = np.random.default_rng(0).random((4000, 8))
    assert np.mean([differ_together(row).any() for row in p]) == pytest.approx(0.05, abs=0.012)
