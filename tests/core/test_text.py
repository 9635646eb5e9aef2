"""Numbers in words."""

import ast
import math
import re
from pathlib import Path

import pytest

from fractalcontact.core import text
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.text import (
    MISSING,
    compact,
    duration,
    interval,
    measured,
    number,
    percent,
    plus_minus,
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


def test_a_length_is_in_micrometres_from_one_of_them_to_a_thousand():
    lengths = (1.0, 0.5, 0.005, 1e-3, 5e-4)
    words = ["1 mm", "500 µm", "5 µm", "1 µm", "500 nm"]
    assert [with_unit(one, "mm") for one in lengths] == words


def test_uneven_ends_stand_in_brackets():
    assert interval(1.0, 0.9, 1.13) == "1.00 [0.900, 1.13]"
    assert interval(1.0, 0.9, 1.1) == "1.00 ± 0.10"


def test_what_is_undetermined_is_shown_with_its_error():
    assert undetermined(interval(0.96, 0.02, 1.9)) == "undetermined (0.960 ± 0.94)"
    assert undetermined(interval(212, 49.1, 914)) == "undetermined (212 [49.1, 914])"
    assert undetermined(interval(1.4, math.nan, math.nan)) == "undetermined (1.40, error not known)"
    assert interval(math.nan, math.nan, math.nan) == "–"


@pytest.mark.parametrize("error", [math.nan, math.inf])
def test_an_error_that_is_not_known_has_no_sign(error):
    assert with_unit(math.nan, "mm") == MISSING
    assert plus_minus(error, with_unit(error, "mm")) == "error not known"
    assert plus_minus(0.5, "0.5 mm") == "± 0.5 mm"


@pytest.mark.parametrize(
    ("fraction", "words"),
    [
        (0, "0 %"),
        (3e-8, "<0.0001 %"),
        (0.000512, "0.051 %"),
        (0.032, "3.2 %"),
        (0.62, "62 %"),
        (0.994, "99.4 %"),
        (0.9965, "99.7 %"),
        (1, "100 %"),
        (1.234, "120 %"),
        (-0.06, "−6 %"),
        (math.nan, "–"),
    ],
)
def test_a_fraction_has_two_digits_and_three_near_all(fraction, words):
    assert percent(fraction) == words


def test_an_estimate_has_its_interval_in_the_form_of_the_number():
    assert number(Estimate(0.954, 0.9, 1.011)) == "0.95 [0.90, 1.01]"
    assert number(Estimate(-0.001, -0.2, 0.2), 2, "+") == "+0.00 [-0.20, +0.20]"
    assert compact(Estimate(12345, 0.9, 1.2e7)) == "12300 [0.9, 1.2e+07]"


#: Rooms that show numbers, and what a format of a number in their strings begins with.
ROOMS = ("pages", "cards", "report", "figures", "statements")
FORMAT = re.compile(r"\.\d+[fge%]|[+z]|^g$")


def formats(path):
    """Formats of numbers in the f-strings of a module, by line."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FormattedValue) and node.format_spec is not None:
            parts = node.format_spec.values
            spec = "".join(part.value for part in parts if isinstance(part, ast.Constant))
            if FORMAT.search(spec):
                yield f"{path.name}:{node.lineno}: {spec}"


@pytest.mark.parametrize("room", ROOMS)
def test_a_number_becomes_text_in_one_module(room):
    """No format, and no function of its own, makes a number text where it is shown."""
    folder = Path(text.__file__).parents[1] / room
    paths = sorted(folder.rglob("*.py"))
    assert paths
    assert [found for path in paths for found in formats(path)] == []
    own = re.compile(
        r"^def (percent|short|measured|with_unit|interval|number)\(.*(float|share)", re.M
    )
    assert [path.name for path in paths if own.search(path.read_text())] == []


def test_an_end_that_is_not_known_is_said_so():
    estimate = Estimate(0.12, 0.03, math.nan)
    assert number(estimate, 2, "+") == "+0.12 [+0.03, not known]"
