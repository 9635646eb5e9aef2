"""Cells of the tables of the pages: a published number in words."""

import math

from ..core.text import (
    MISSING,
    interval,
    measured,
    percent,
    plus_minus,
    short,
    undetermined,
    with_unit,
)
from ..report.published import Number, Row
from .summary import Sheet


def absent(row: Row, number: Number) -> str:
    """Reason why a page prints no number; empty where it prints one."""
    return number.missing or (row.zero if row.zero and number.value == 0 else "")


def value_words(row: Row, number: Number) -> str:
    """Number in the unit that suits it."""
    return bare_words(number) if row.unit == "1" else with_unit(number.value, row.unit)


def bare_words(number: Number) -> str:
    """Number without its unit; of a count every digit."""
    return short(number.value, 3 if abs(number.value) < 1000 else 6)


def error_words(row: Row, number: Number, error: float) -> str:
    """Error in per cent of the number, or in its unit where that may be zero or negative."""
    in_unit = row.signed or not number.estimate.known or number.value == 0
    words = with_unit(error, row.unit, 2) if in_unit else percent(abs(error / number.value))
    return plus_minus(error, words)


def estimate_words(number: Number) -> str:
    """Number with its interval, as figures print it."""
    estimate = number.estimate
    if not estimate.known:
        return MISSING
    if not number.determined:
        return undetermined(interval(*estimate.ends))
    ends = (
        f" [{measured(estimate.low)}, {measured(estimate.high)}]"
        if math.isfinite(estimate.low)
        else ""
    )
    return measured(estimate.value) + ends


def sort_value(sheet: Sheet, row: Row, load: int | None = None) -> float | str:
    """Sort key of a cell: a number, empty where it is missing or undetermined."""
    number = sheet.of(row.name, load)
    return shown(number.value) if number.determined and not number.missing else ""


def shown(value: float) -> float | str:
    """Number as an attribute of the page: empty where it is missing."""
    return value if math.isfinite(value) else ""
