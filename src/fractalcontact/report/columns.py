"""Columns of a table that a published number fills: one rule for their names."""

import math
import re
from typing import Any

from ..core.estimate import Estimate, column_of
from .published import Number, Row


def columns_of(row: Row, number: Number) -> dict[str, Any]:
    """Columns of a number: NAME, NAME_low, NAME_high, NAME_error_surface and so on, the unit last.

    A number that is no result, such as a strength that is only a bound, is empty with its ends.
    NAME_error alone is the solver error bound, as in the atlas and the tables of figures.
    """
    name = _column(row, number)
    if number.missing:
        nan = math.nan
        number = number._replace(estimate=Estimate(), error=nan, population=nan, hardest=nan)
    fields = {"": number.value}
    if row.uncertain:
        fields |= {"low": number.estimate.low, "high": number.estimate.high}
    if row.budget:
        fields |= {"error_surface": number.error, "error_population": number.population}
    if row.budget or row.hardest:
        fields["hardest"] = number.hardest
    columns: dict[str, Any] = {column_of(name, row.unit, of): value for of, value in fields.items()}
    if row.range or row.dimension:
        columns[column_of(name, "", "determined")] = number.determined
    if row.why:
        columns[column_of(name, "", "reason")] = number.remark
    return columns


def old_columns_of(row: Row, number: Number) -> dict[str, Any]:
    """Columns of a fit by their names of release 1.0, the unit first."""
    if not row.range or row.unit == "1":
        return {}
    start = column_of(_column(row, number), row.unit)
    ends = {
        "low": number.estimate.low,
        "high": number.estimate.high,
        "determined": number.determined,
    }
    return {f"{start}_{of}": value for of, value in ends.items()}


def _column(row, number):
    labels = {
        key: re.sub(r"\W+", "_", label) if isinstance(label, str) else label
        for key, label in number.at.items()
    }
    return row.summary.format(**labels)
