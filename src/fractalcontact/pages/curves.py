"""Curves against pressure, at the offset of the contact maps, to lay over those of others."""

from typing import Any

import pandas as pd

from ..core.subject import Subject
from ..report.published import read, shown_in

#: Columns of the file, which the page of another study reads.
COLUMNS = (
    "study",
    "specimen",
    "label",
    "direction",
    "offset_mm",
    "quantity",
    "unit",
    "nominal_pressure_MPa",
    "value",
    "low",
    "high",
    "resolved",
)


def curves_table(study: str, subjects: list[Subject]) -> pd.DataFrame:
    """Curves of specimens, one row a point, with the total error of this surface or their interval.

    A point is ``resolved`` where ten nodes touch, most of the force acts on sound cells of the scan
    and, of a dimension, its interval determines it; figures draw the others hollow. Points that
    were not solved are left out.
    """
    rows: list[dict[str, Any]] = []
    for subject in subjects:
        start = (study, subject.name, subject.label, subject.direction, subject.offset)
        enough = subject.states("closure")["resolved"].values.astype(bool)
        for row in shown_in("curves"):
            for number, resolved in zip(read(row, subject), enough, strict=True):
                # Closure is 0 at the seat by definition.
                if number.estimate.known and not (row.zero and number.value == 0):
                    ends = (float(end) for end in number.estimate.ends)
                    says = bool(resolved) and number.determined
                    values = (row.curves, row.unit, float(number.at["pressure"]), *ends, says)
                    rows.append(dict(zip(COLUMNS, (*start, *values), strict=True)))
    return pd.DataFrame(rows, columns=list(COLUMNS))
