"""Curves against pressure, at the offset of the contact maps, to lay over those of others."""

from typing import Any

import numpy as np
import pandas as pd

from ..core.estimate import DIMENSION, Estimate
from ..core.subject import Subject

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

    Closure, tangent stiffness and corrected area with the total error of this surface, both
    Delta_sigma with their intervals. A point is ``resolved`` where ten nodes touch and, of a
    dimension, where its interval determines it; figures draw the others hollow.
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
        for quantity, unit, found in _quantities(one):
            rows += [
                start
                | {
                    "quantity": quantity,
                    "unit": unit,
                    "nominal_pressure_MPa": float(pressures[i]),
                    "value": float(found.value[i]),
                    "low": float(found.low[i]),
                    "high": float(found.high[i]),
                    "resolved": bool(enough[i] and _says(found[i])),
                }
                for i in np.flatnonzero(found.known)
            ]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _says(found):
    """True if the interval of a dimension determines it; of other quantities it is an error."""
    return found.scale != DIMENSION or found.determined


def _quantities(one):
    """Name, unit and estimates of each curve over the loads."""
    closure = one.states("closure")
    budget = one["error_budget"].sel(normal_force=one.forces, method="nearest")
    seated, error = closure["seated_closure"].values, budget["seated_closure_total"].values
    # At the seat it is 0 by definition.
    above = np.where(seated > 0, seated, np.nan)
    yield "closure from the seat", "mm", Estimate.about(above, error, 0.0)
    share = closure["area_corrected_share"].values
    of_values = (
        ("closure from first touch", "mm", closure["interface_closure"].values, "closure"),
        ("tangent stiffness", "MPa/mm", closure["interface_stiffness"].values, "stiffness"),
        ("real contact area A_r/A_0", "mm2/mm2", share, "area_corrected"),
    )
    for words, unit, values, name in of_values:
        error = abs(values) * budget["relative_total"].sel(quantity=name).values
        most = 1.0 if name == "area_corrected" else np.inf
        yield words, unit, Estimate.about(values, error, 0.0, most)
    for words, stage in (("by box counting", "domains"), ("by areas", "scaling")):
        found = Estimate.read(one.states(stage), "delta_sigma", scale=DIMENSION)
        yield f"Delta_sigma {words}", "1", found
