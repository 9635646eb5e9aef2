"""Solve plan of a study: quantities, values, reasons and the errors that they leave.

A study states how far off a closure and a Delta_sigma may be. From that follow the tolerance of the
solver and which states :func:`states.plan.solved_loads` names. The plan is kept with its reasons
and with the error it makes, as far as that can be estimated from the states themselves.
"""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..core.datasets import Dims, labelled_dataset
from ..core.directions import NO_SLIDING
from ..core.settings import Solver
from ..core.tolerance import SHARE_OF_CLOSURE, SHARE_OF_DIMENSION, tolerance


def solve_plan(
    curves: xr.Dataset,
    dilatancy: xr.Dataset,
    solver: Solver,
    budget: xr.Dataset | None = None,
) -> xr.Dataset:
    """The solve plan of a specimen: quantity, value, reason and estimated error.

    ``value``, ``reason``, ``error_of`` and ``error`` (a fraction; NaN where there is none) over
    ``choice``; the requested accuracy as attribute ``asked``. With the stage ``error_budget`` the
    plan says what the spacing leaves uncertain.
    """
    solved, requested = curves["solved"], solver.accuracy
    rows = [
        _of_tolerance(curves, solver, requested),
        _of_loads(curves, dilatancy, requested),
        _of_directions(curves),
        _of_resolutions(curves),
        _of_extent(curves),
    ]
    if budget is not None:
        rows.append(_of_spacing(budget, requested))
    columns = (list(column) for column in zip(*rows, strict=True))
    return labelled_dataset(
        _COLUMNS,
        dict(zip(_COLUMNS, columns, strict=True)),
        attrs={
            "asked": _requested(requested),
            "states": int(solved.size),
            "states_solved": int(solved.sum()),
        },
    )


_COLUMNS: dict[str, tuple[Dims, str, str]] = {
    "choice": ("choice", "1", "quantity"),
    "value": ("choice", "1", "value"),
    "reason": ("choice", "1", "reason"),
    "error_of": ("choice", "1", "quantity of the error"),
    "error": ("choice", "1", "largest error it is estimated to make, a fraction"),
}


def _requested(accuracy: Mapping[str, float] | None) -> str:
    if accuracy is None:
        return "all states, at any cost"
    closure = 100 * accuracy["closure"]
    return f"closure to {closure:.3g} %, Delta_sigma to {accuracy['delta_sigma']:.3g}"


def _largest(values: xr.DataArray) -> float:
    """Largest value that is not missing, or NaN."""
    finite = values.values[np.isfinite(values.values)]
    return float(finite.max(initial=-np.inf)) if finite.size else np.nan


def _of_tolerance(curves, solver: Solver, requested):
    reason = (
        "stated by the study"
        if requested is None or solver.rtol != tolerance(requested)
        else f"{SHARE_OF_CLOSURE:g} of the requested error of the closure, {SHARE_OF_DIMENSION:g} "
        "of that of Delta_sigma; errors in trials were at least ten times smaller than "
        "requested"
    )
    error = abs(curves["closure_error"] / curves["interface_closure"].where(lambda w: w != 0))
    return "solver tolerance", f"{solver.rtol:.1g}", reason, "interface closure", _largest(error)


def _of_loads(curves, dilatancy, requested):
    closure = curves["interface_closure"].sel(resolution=curves["resolution"].min())
    misses = dilatancy["left_out_error"].rename(contact_direction="direction")
    errors = abs(misses / closure.where(closure != 0))
    finite = errors.values[np.isfinite(errors.values)]
    value = f"{closure.sizes['normal_force']} in the first direction, none interpolated"
    if not finite.size:
        return "load steps", value, "too few to interpolate between", "", np.nan
    within = np.mean(finite <= requested["closure"]) if requested else np.nan
    reason = (
        f"interpolated between its neighbours a closure would be off by "
        f"{100 * np.median(finite):.1f} % (median) to {100 * finite.max():.0f} %"
        + (f"; {100 * within:.0f} % would be as exact as requested" if requested else "")
    )
    return "load steps", value, reason, "interface closure, if every second were left out", np.nan


def _of_directions(curves):
    solved = curves["solved"].sel(resolution=curves["resolution"].min())
    counts = solved.any("offset").sum("normal_force")
    value = "; ".join(
        f"{NO_SLIDING} does not slide" if direction == "none" else f"{direction}: {int(n)} loads"
        for direction, n in zip(curves["direction"].values, counts.values, strict=True)
    )
    reason = "directions after the first show dilatancy alone, under its loads"
    return "directions", value, reason, "", np.nan


def _of_resolutions(curves):
    solved = curves["solved"].any("normal_force")
    n_curves = solved.sizes["direction"] * solved.sizes["offset"]
    counts = solved.sum(["direction", "offset"])
    value = "; ".join(
        f"{_nodes_words(int(k))}: {int(n)} of {n_curves} curves"
        for k, n in zip(curves["resolution"].values, counts.values, strict=True)
    )
    reason = (
        "closure and contact are those of all nodes; their change with the resolution is solved "
        "at the reported offset alone"
    )
    return (
        "resolutions",
        value,
        reason,
        "interface closure, by every second node (another surface)",
        _largest(abs(curves["closure_spacing_error"] / curves["interface_closure"])),
    )


def _nodes_words(k):
    """A resolution in words: every k-th node."""
    return "all nodes" if k == 1 else "every " + {2: "2nd", 3: "3rd"}.get(k, f"{k}th")


def _of_extent(curves):
    extent = curves["extent"].isel(direction=0).sel(resolution=curves["resolution"].min())
    lightest, heaviest = (float(extent.isel(normal_force=i).median("offset")) for i in (0, -1))
    reason = (
        f"a rectangle around the contact takes {100 * lightest:.0f} % of the window under the "
        f"smallest load and {100 * heaviest:.0f} % under the largest, which costs most"
    )
    value = "equations on the contact set, displacements on the whole window"
    return "extent of the solve", value, reason, "", np.nan


def _of_spacing(budget, requested):
    """Numerical error of the closure, and whether that asked for can be had at this spacing."""
    errors = budget["relative_error"].sel(quantity="closure", source="numerical").values
    refined = np.isfinite(budget["finest_spacing"].values)
    determined = refined & np.isfinite(errors)
    name = "numerical error of the closure"
    if not determined.any():
        words = str(budget["reason"].sel(quantity="closure", source="numerical").values)
        return name, "not known", words or "no refined state gives one", "", np.nan
    spacings = budget["finest_spacing"].values[refined]
    value = f"refined at {refined.sum()} of {len(refined)} loads, down to {spacings.min():.3g} mm"
    of_known = errors[determined]
    least, most = (100 * float(f"{end:.2g}") for end in (of_known.min(), of_known.max()))
    reason = f"at this spacing {least:g} to {most:g} %"
    if requested is not None:
        asked = requested["closure"]
        reached = int(np.count_nonzero(of_known <= asked))
        reason += f"; {100 * asked:g} % reached under {reached} of {determined.sum()} loads"
    quantity = "interface closure, by the grid (same surface)"
    return name, value, reason, quantity, float(of_known.max())
