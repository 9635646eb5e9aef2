"""Quantities if contacts are harder: their range over hardnesses, a source of error of its own.

The joint wall strength at which contacts crush is that of the rock in bulk; what single contacts
bear lies between it and Tabor's three times of it.
"""

from collections.abc import Mapping

import numpy as np

from roughcontact.contact.path import loaded_state
from roughcontact.contact.state import ContactState

from ..core.datasets import labelled
from ..core.limits import HARDEST, REFERENCE_PRESSURES
from ..flow.aperture import crushed_reason
from ..flow.cubic_law import WAYS, flow_of
from ..flow.joint_flow import flow_axes
from ..flow.network import hydraulic_aperture
from ..laws.reference_states import further_pressures, with_curve_stiffness
from ..laws.seated_laws import at_reference_pressures
from ..states.state_quantities import state_quantities
from ..states.state_scalars import aperture
from ..states.sweep import load_steps
from .refinement import (
    BUDGET_QUANTITIES,
    LoadCurve,
    budget_dimension,
    chosen_loads,
    in_order,
)

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
    **{
        f"{name}_{way}_hardest": (_LOADS, unit, f"{words}, {way} the sliding, {_IF}")
        for way in WAYS
        for name, unit, words in (
            ("transmissivity", "mm3", "transmissivity T = h_h^3/12 per unit viscosity"),
            ("hydraulic_aperture", "mm", "hydraulic aperture h_h"),
        )
    },
}


def of_the_hardest(curve: LoadCurve) -> dict[str, tuple]:
    """Quantities of a load curve at :data:`HARDEST` times its hardness, :data:`_TABLE`.

    NaN where contacts are elastic. Raises `NotConverged`.
    """
    hardness = HARDEST * curve.loading.solving["hardness"]
    hardest, gap, flows, at_reference = _solved(curve, hardness)
    by_quantity = dict(zip(BUDGET_QUANTITIES, hardest, strict=True))
    values = {
        "hardest_hardness": hardness if np.isfinite(hardness) else np.nan,
        "hardest": hardest,
        "mean_gap_hardest": gap,
        "contact_fraction_hardest": by_quantity["area_corrected"] / curve.loading.area,
        "seated_closure_hardest": _seated(curve, by_quantity["separation"]),
        "reference_stiffness_hardest": at_reference,
        **{f"transmissivity_{way}_hardest": flow for way, flow in flows.items()},
        **{
            f"hydraulic_aperture_{way}_hardest": hydraulic_aperture(flow)
            for way, flow in flows.items()
        },
    }
    return labelled(_TABLE, values)


def _solved(
    curve: LoadCurve, hardness: float
) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray], np.ndarray]:
    """Values (quantity, normal_force) at a hardness, mean gaps, T by way, reference stiffness.

    All of them are NaN where the hardness is infinite.
    """
    values = curve.over_quantities()
    gaps = np.full(len(curve.forces), np.nan)
    flows = {way: gaps.copy() for way in WAYS}
    if not np.isfinite(hardness):
        return values, gaps, flows, np.full(len(REFERENCE_PRESSURES), np.nan)
    loading = curve.loading
    drawn = chosen_loads(curve, loading.settings.drawn_loads)
    axes = flow_axes(loading)
    solving = {**loading.solving, "hardness": hardness}
    where, highest = f"{curve.where}, hardness x {HARDEST:g}", float(curve.composite.max())
    further = further_pressures(curve.forces / loading.area) * loading.area
    every = np.union1d(curve.forces, further)
    of_curve = {name: np.full(len(every), np.nan) for name in ("stiffness", "closure")}
    states = load_steps(curve.composite, curve.space, every, solving, where)
    for number, state in enumerate(states):
        quantities = state_quantities(state, highest, curve.reference)
        for name, numbers in of_curve.items():
            numbers[number] = quantities[name]
        if every[number] not in curve.forces:
            continue
        place = int(np.searchsorted(curve.forces, every[number]))
        limits = loading.settings.box_range
        values[:, place] = in_order(quantities, delta_sigma=budget_dimension(state, limits))
        gaps[place] = aperture(state).mean()
        if place in drawn:
            for way, flow in _flows(state, axes).items():
                flows[way][place] = flow
    pressure = every / loading.area
    stiffness = with_curve_stiffness(pressure, of_curve["stiffness"], of_curve["closure"])
    return values, gaps, flows, at_reference_pressures(pressure, stiffness)


def _flows(state: ContactState, axes: Mapping[str, str]) -> dict[str, float]:
    """T of a state by way, mm3; NaN where it is not resolved, or crushed rock may fill the gap."""
    gap = aperture(state)
    crushed = loaded_state(state).permanent_set.mean()
    if gap.any() and crushed_reason(crushed / gap.mean()):
        return dict.fromkeys(axes, np.nan)
    flows = {way: flow_of(gap, state.space.spacing, axis) for way, axis in axes.items()}
    return {way: flow.transmissivity if flow.resolved else np.nan for way, flow in flows.items()}


def _seated(curve: LoadCurve, separation: np.ndarray) -> np.ndarray:
    """Closure from the seat of faces with these separations, mm.

    Harder faces have come together since the seat by less: by the difference of their separation
    there, less that at the seat.
    """
    seated = curve.curve["seated_closure"].values
    wider = separation - curve.separation
    seat = np.flatnonzero(seated == 0)
    return seated + (wider[seat[0]] - wider if seat.size else np.nan)
