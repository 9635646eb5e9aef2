"""Numbers in words."""

import math

import pytest

from fractalcontact.core.text import (
    duration,
    interval,
    measured,
    percent,
    short,
    undetermined,
    with_unit,
)


@pytest.mark.parametrize(
    ("value", "trimmed", "whole"),
    [
        (2.2, "2.2", "2.20"),
        (-0.05, "−0.05", "−0.0500"),
        (19.999, "20", "20.0"),
        (0, "0", "0"),
        (123456, "123000", "123000"),
        (0.9996, "1", "1.00"),
        (1.234e-7, "1.23e−07", "1.23e−07"),
        (-9.0e-6, "−9e−06", "−9.00e−06"),
        (math.inf, "–", "–"),
        (float("nan"), "–", "–"),
    ],
)
def test_three_digits(value, trimmed, whole):
    assert short(value) == trimmed
    assert measured(value) == whole


def test_units_suit_the_number():
    assert with_unit(0.0123, "mm") == "12.3 µm"
    assert with_unit(1.65, "mm2") == "1.65 mm²"
    assert with_unit(2760, "MPa/mm") == "2.76 GPa/mm"
    assert with_unit(30000, "N") == "30 kN"
    assert with_unit(1.3, "1") == "1.3"
    assert with_unit(math.nan, "mm") == "–"
    assert percent(0.0469) == "4.7 %"
    assert [duration(s) for s in (47, 192, 7500)] == ["47 s", "3 min 12 s", "2 h 5 min"]


def test_what_is_undetermined_is_shown_with_its_error():
    assert undetermined(interval(0.96, 0.02, 1.9)) == "undetermined (0.960 ± 0.94)"
    assert undetermined(interval(212, 49.1, 914)) == "undetermined (212 [49.1, 914])"
    assert undetermined(interval(1.4, math.nan, math.nan)) == "undetermined (1.40, error not known)"
    assert interval(math.nan, math.nan, math.nan) == "–"
