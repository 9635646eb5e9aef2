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


def absent(row: Row, one: Number) -> str:
    """Reason why a page prints no number; empty where it prints one."""
    return one.missing or (row.zero if row.zero and one.value == 0 else "")


def value_words(row: Row, one: Number) -> str:
    """Number in the unit that suits it."""
    return bare_words(one) if row.unit == "1" else with_unit(one.value, row.unit)


def bare_words(one: Number) -> str:
    """Number without its unit; of a count every digit."""
    return short(one.value, 3 if abs(one.value) < 1000 else 6)


def error_words(row: Row, one: Number, error: float) -> str:
    """Error in per cent of the number, or in its unit where that may be zero or negative."""
    in_unit = row.signed or not one.estimate.known or one.value == 0
    words = with_unit(error, row.unit, 2) if in_unit else percent(abs(error / one.value))
    return plus_minus(error, words)


def estimate_words(one: Number) -> str:
    """Number with its interval, as figures print it."""
    found = one.estimate
    if not found.known:
        return MISSING
    if not one.determined:
        return undetermined(interval(*found.ends))
    ends = f" [{measured(found.low)}, {measured(found.high)}]" if math.isfinite(found.low) else ""
    return measured(found.value) + ends


def sort_value(sheet: Sheet, row: Row, load: int | None = None) -> float | str:
    """Sort key of a cell: a number, empty where it is missing or undetermined."""
    one = sheet.of(row.name, load)
    return shown(one.value) if one.determined and not one.missing else ""


def shown(value: float) -> float | str:
    """Number as an attribute of the page: empty where it is missing."""
    return value if math.isfinite(value) else ""
