"""Quantities if contacts are harder: their range over hardnesses, a source of error of its own.

The joint wall strength at which contacts crush is that of the rock in bulk; what single contacts
bear lies between it and Tabor's three times of it.
"""

import numpy as np

from ..core.datasets import labelled
from ..laws.seated_laws import at_reference_pressures
from ..states.state_scalars import aperture
from ..states.sweep import load_steps
from .refinement import BUDGET_QUANTITIES, LoadCurve, budget_values

#: Largest ratio of the hardness of rough contacts to the joint wall strength (Tabor's 3).
HARDEST = 3.0

_LOADS = ("normal_force",)
_IF = f"if contacts are {HARDEST:g} times as hard; missing where they are elastic"
_TABLE = {
    "hardest_hardness": ((), "MPa", "hardness of contacts at the upper end of its range"),
    "hardest": (("quantity", *_LOADS), "unit of the quantity", f"value of the quantity {_IF}"),
    "mean_gap_hardest": (_LOADS, "mm", f"mean gap {_IF}"),
    "contact_fraction_hardest": (_LOADS, "1", f"corrected A_r/A_0 {_IF}"),
    "seated_closure_hardest": (_LOADS, "mm", f"closure from the seat {_IF}"),
    "reference_stiffness_hardest": (
        ("reference_pressure",),
        "MPa/mm",
        f"tangent stiffness of the interface at a pressure {_IF}",
    ),
}


def of_the_hardest(curve: LoadCurve) -> dict[str, tuple]:
    """Quantities of a load curve at :data:`HARDEST` times its hardness, :data:`_TABLE`.

    NaN where contacts are elastic. Raises `NotConverged`.
    """
    hardness = HARDEST * curve.loading.solving["hardness"]
    hardest, gap = _solved(curve, hardness)
    by_quantity = dict(zip(BUDGET_QUANTITIES, hardest, strict=True))
    pressure = curve.curve["nominal_pressure"].values
    values = {
        "hardest_hardness": hardness if np.isfinite(hardness) else np.nan,
        "hardest": hardest,
        "mean_gap_hardest": gap,
        "contact_fraction_hardest": by_quantity["area_corrected"] / curve.loading.area,
        "seated_closure_hardest": _seated(curve, by_quantity["separation"]),
        "reference_stiffness_hardest": at_reference_pressures(pressure, by_quantity["stiffness"]),
    }
    return labelled(_TABLE, values)


def _solved(curve: LoadCurve, hardness: float) -> tuple[np.ndarray, np.ndarray]:
    """Values (quantity, normal_force) at a hardness, and mean gaps; NaN if it is infinite."""
    values = curve.over_quantities()
    gaps = np.full(len(curve.forces), np.nan)
    if not np.isfinite(hardness):
        return values, gaps
    solving = {**curve.loading.solving, "hardness": hardness}
    where, highest = f"{curve.where}, hardness x {HARDEST:g}", float(curve.composite.max())
    states = load_steps(curve.composite, curve.space, curve.forces, solving, where)
    for place, state in enumerate(states):
        limits = curve.loading.settings.box_range
        values[:, place] = budget_values(state, highest, curve.reference, limits)
        gaps[place] = aperture(state).mean()
    return values, gaps


def _seated(curve: LoadCurve, separation: np.ndarray) -> np.ndarray:
    """Closure from the seat of faces with these separations, mm.

    Harder faces have come together since the seat by less: by the difference of their separation
    there, less that at the seat.
    """
    seated = curve.curve["seated_closure"].values
    wider = separation - curve.separation
    seat = np.flatnonzero(seated == 0)
    return seated + (wider[seat[0]] - wider if seat.size else np.nan)
