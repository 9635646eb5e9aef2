"""Columns of a table that a published number fills: one rule for their names."""

import re
from typing import Any

from ..core.estimate import column_of
from .published import Number, Row


def columns_of(row: Row, one: Number) -> dict[str, Any]:
    """Columns of a number: NAME, NAME_low, NAME_high, NAME_error_surface and so on, the unit last.

    NAME_error alone is the bound of the solver's error, as in the atlas and the tables of figures.
    """
    name = _column(row, one)
    found = {"": one.value}
    if row.uncertain:
        found |= {"low": one.estimate.low, "high": one.estimate.high}
    if row.budget:
        found |= {"error_surface": one.error, "error_population": one.population}
    if row.budget or row.hardest:
        found["hardest"] = one.hardest
    columns: dict[str, Any] = {column_of(name, row.unit, of): each for of, each in found.items()}
    if row.range or row.dimension:
        columns[column_of(name, "", "determined")] = one.determined
    if row.why:
        columns[column_of(name, "", "reason")] = one.remark
    return columns


def old_columns_of(row: Row, one: Number) -> dict[str, Any]:
    """Columns of a fit by the names that they had in release 1.0, the unit first."""
    if not row.range or row.unit == "1":
        return {}
    start = column_of(_column(row, one), row.unit)
    ends = {"low": one.estimate.low, "high": one.estimate.high, "determined": one.determined}
    return {f"{start}_{of}": each for of, each in ends.items()}


def _column(row, one):
    of = {key: re.sub(r"\W+", "_", at) if isinstance(at, str) else at for key, at in one.at.items()}
    return row.summary.format(**of)
