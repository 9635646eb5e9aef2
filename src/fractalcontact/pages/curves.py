"""Curves against pressure, at the offset of the contact maps, to lay over those of others."""

from typing import Any

import numpy as np
import pandas as pd

from ..core.determined import determined
from ..core.estimate import Estimate
from ..core.subject import Subject
from .summary import DIMENSION
from .words import finite

#: Of dimensions: an area has one of its own.
DIMENSION_UNIT = "1"

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
    """Curves of specimens, one row a point; points that were not solved are left out.

    Interface closure, tangent stiffness and corrected area with the total error of this surface,
    both Delta_sigma with their intervals. A point is ``resolved`` where ten nodes touch and, of a
    dimension, where its interval determines it; figures draw the others hollow.

    Parameters
    ----------
    study : str
    subjects : list of Subject
    """
    rows: list[dict[str, Any]] = []
    for one in subjects:
        start = {
            "study": study,
            "specimen": one.name,
            "label": one.label,
            "direction": one.direction,
            "offset_mm": one.offset,
        }
        states = one.states("closure")
        enough, pressures = states["resolved"].values.astype(bool), states["nominal_pressure"]
        for quantity, unit, values, low, high in _quantities(one):
            says = [_says(unit, *ends) for ends in zip(values, low, high, strict=True)]
            rows += [
                start
                | {
                    "quantity": quantity,
                    "unit": unit,
                    "nominal_pressure_MPa": float(pressures[i]),
                    "value": float(values[i]),
                    "low": finite(low[i]),
                    "high": finite(high[i]),
                    "resolved": bool(enough[i] and says[i]),
                }
                for i in np.flatnonzero(np.isfinite(values))
            ]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _says(unit, value, low, high):
    """Whether the interval of a dimension determines it; of other quantities it is an error."""
    return unit != DIMENSION_UNIT or determined(value, low, high, **DIMENSION)


def _quantities(one):
    """Name, unit, values and ends of each curve over the loads."""
    closure = one.states("closure")
    budget = one["error_budget"].sel(normal_force=one.forces, method="nearest")
    share = closure["area_corrected_share"].values
    of_values = (
        ("interface closure", "mm", closure["interface_closure"].values, "closure"),
        ("tangent stiffness", "MPa/mm", closure["interface_stiffness"].values, "stiffness"),
        ("real contact area A_r/A_0", "mm2/mm2", share, "area_corrected"),
    )
    for words, unit, values, name in of_values:
        error = abs(values) * budget["relative_total"].sel(quantity=name).values
        yield words, unit, values, values - error, values + error
    for words, stage in (("by box counting", "domains"), ("by areas", "scaling")):
        found = Estimate.read(one.states(stage), "delta_sigma")
        yield f"Delta_sigma {words}", DIMENSION_UNIT, *found.ends
