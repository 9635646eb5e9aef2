"""Quantities as people write them."""

import itertools
import math
import time

import pytest

from fractalcontact.core import units
from fractalcontact.core.errors import InputError
from fractalcontact.core.units import length_factor, length_unit, load, quantity


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("20 mm", "length", 20),
        ("0.5 um", "length", 5e-4),
        ("80 µm", "length", 0.08),
        ("0.02 m", "length", 20),
        ("20 GPa", "pressure", 20e3),
        ("10 kN", "force", 10e3),
        ("-1.5e-3mm", "length", -1.5e-3),
        ("2 N/mm^2", "pressure", 2),
        ("2 kgf / cm**2", "pressure", 0.196133),
    ],
)
def test_known_quantities(text, kind, value):
    assert quantity(text, kind, "key") == pytest.approx(value, rel=1e-12)


#: Numbers as studies have them, some with more digits than a double.
NUMBERS = ("20", "0.1", "12.5", "3.", "1e3", "7.3e-2", "0.0390625", "9007199254740993", "0.3")


@pytest.mark.parametrize("unit", units._COMMON)
def test_common_units_are_those_of_the_library_to_the_last_bit(unit):
    """A common unit of one kind is none of the other kinds, in the library's words."""
    own = units._COMMON[unit][0]
    for kind, number in itertools.product(units.PROGRAM_UNITS, NUMBERS):
        text, wanted = f"{number} {unit}", units._wanted(kind)
        if kind == own:
            assert quantity(text, kind, "k") == units._by_library(text, kind, wanted)
            continue
        with pytest.raises(InputError) as by_library:
            units._by_library(text, kind, wanted)
        with pytest.raises(InputError) as common:
            units.magnitude(text, kind)
        assert str(common.value) == str(by_library.value)


def test_common_units_need_no_library(monkeypatch):
    monkeypatch.setattr(units, "_registry", None)
    units.magnitude.cache_clear()
    assert load("2.5 MPa", "k") == (2.5, "pressure")
    assert quantity("80 µm", "length", "k") == pytest.approx(0.08)


@pytest.mark.parametrize("text", ["20", 20, "20 MPa", "20 mmm", "", None, "__import__('os')"])
def test_what_is_no_length_is_refused_by_its_key(text):
    with pytest.raises(InputError, match=r"study\.yaml: window: .*'20 mm'"):
        quantity(text, "length", "study.yaml: window")


@pytest.mark.parametrize(
    "text",
    ["9**9**9**9 mm", "1 mm*9**9**9", "1 mm + 1 mm", "1e999 mm", "nan mm", "1 " + "a" * 57 + "!"],
)
def test_a_quantity_is_one_finite_number_and_no_sum(text):
    start = time.monotonic()
    with pytest.raises(InputError, match=r"key: .*'20 mm'"):
        quantity(text, "length", "key")
    assert time.monotonic() - start < 2


def test_loads_are_forces_or_pressures():
    assert load("2 kN", "k") == (2000.0, "force")
    assert load("2.5 MPa", "k") == (2.5, "pressure")
    with pytest.raises(InputError, match="neither a force nor a nominal pressure"):
        load("2 mm", "k")


def test_units_of_length():
    assert length_factor("um", "k") == pytest.approx(1e-3)
    with pytest.raises(InputError):
        length_factor("kN", "k")


@pytest.mark.parametrize(
    ("units", "mm"),
    [
        (("mm", "MM", "Millimeter", "millimetres", "millimeters"), 1),
        (("um", "µm", "\u03bcm", "micron", "Microns", "micrometre"), 1e-3),
        (("m", "metre", "Meters"), 1e3),
        (("in", "inch", "Inches"), 25.4),
        (("ft", "foot", "feet"), 304.8),
        (("Å", "\u212b", "angstrom"), 1e-7),
        (("nm",), 1e-6),
        (("cm",), 10),
    ],
)
def test_lengths_have_many_names(units, mm):
    for unit in units:
        assert length_factor(unit, "k") == pytest.approx(mm, rel=1e-12)
        assert quantity(f"2 {unit}", "length", "k") == pytest.approx(2 * mm, rel=1e-12)


@pytest.mark.parametrize("unit", ["px", "point", "pica", "Mm", "yard", "light_year", "mil", "rod"])
def test_what_only_the_library_calls_a_length_is_refused(unit):
    for text in (f"1 {unit}", f"0.5 {unit}"):
        with pytest.raises(InputError, match=r"k: .*'20 mm'"):
            quantity(text, "length", "k")
    assert length_unit(unit) is None


def test_what_one_count_is_lies_above_zero():
    assert length_factor("0.1 um", "k") == pytest.approx(1e-4)
    for unit in ("-1 um", "0 mm"):
        with pytest.raises(InputError, match=r"k: .*not above zero"):
            length_factor(unit, "k")


def test_an_angle_needs_its_unit():
    assert quantity("30 deg", "angle", "here") == 30
    assert quantity("0.5 rad", "angle", "here") == pytest.approx(90 / math.pi)
    for wrong in ("30", "3 mm", 30):
        with pytest.raises(InputError, match="expected an angle with its unit, such as '30 deg'"):
            quantity(wrong, "angle", "here")
