"""Curves against pressure, at the offset of the contact maps, to lay over those of others."""

from typing import Any

import numpy as np
import pandas as pd

from ..core.determined import determined
from ..core.estimate import Estimate, names_of
from .chosen import Chosen, finite
from .summary import DIMENSION

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


def curves_table(study: str, chosen: list[Chosen]) -> pd.DataFrame:
    """Curves of specimens, one row a point; points that were not solved are left out.

    Interface closure, tangent stiffness and corrected area with the total error of this surface,
    both Delta_sigma with their intervals. A point is ``resolved`` where ten nodes touch and, of a
    dimension, where its interval determines it; figures draw the others hollow.

    Parameters
    ----------
    study : str
    chosen : list of Chosen
    """
    rows: list[dict[str, Any]] = []
    for one in chosen:
        start = {
            "study": study,
            "specimen": one.name,
            "label": one.label,
            "direction": one.direction,
            "offset_mm": one.offset,
        }
        enough = one.values("closure", "resolved")["resolved"].values.astype(bool)
        for quantity, unit, values, low, high in _quantities(one):
            says = [_says(unit, *ends) for ends in zip(values, low, high, strict=True)]
            rows += [
                start
                | {
                    "quantity": quantity,
                    "unit": unit,
                    "nominal_pressure_MPa": float(one.pressures[i]),
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
    closure = one.values(
        "closure", "interface_closure", "interface_stiffness", "area_corrected_share"
    )
    budget = one.stage("error_budget").sel(normal_force=one.forces, method="nearest")
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
        found = one.values(stage, *names_of("delta_sigma"))
        yield f"Delta_sigma {words}", DIMENSION_UNIT, *Estimate.read(found, "delta_sigma").ends
