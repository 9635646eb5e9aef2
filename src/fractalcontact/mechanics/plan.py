"""No more than needed: what the accuracy a study asks for means for its solves, and why.

A study states how far off a closure and a Delta_sigma may be. From that follow the tolerance of the
solver and which states are solved at all. What was chosen is kept with its reason and with the
error it makes, as far as it can be estimated from the states themselves.
"""

import numpy as np
import xarray as xr

from ..core.labels import cf_attrs
from ..core.tolerance import SHARE_OF_CLOSURE, SHARE_OF_DIMENSION, tolerance
from .states import forces_of


def solved_loads(settings, forces, area, *, first, mapped, factor, everything):
    """Which load steps of a curve are solved.

    Parameters
    ----------
    settings : dict
        From :func:`study.configuration.resolve_settings`.
    forces : (n,) ndarray
        N, ascending.
    area : float
        A_0, mm2.
    first : bool
        Whether the curve is in the first direction whose contact is solved.
    mapped : bool
        Whether it is at the offset of the contact maps.
    factor : int
        Its resolution k.
    everything : bool
        Whether the study asks for all.

    Returns
    -------
    (m,) int ndarray
        Indices of ``forces``, ascending.

    Notes
    -----
    Closure curves, their fits and the contact domains over load are shown in the first direction,
    at the finest resolution; how they change with the resolution, at the offset of the maps. In the
    other directions only the dilatancy under its loads is.
    """
    if everything or (first and (mapped or factor == min(settings["resolutions"]))):
        return np.arange(len(forces))
    if factor != min(settings["resolutions"]):
        return np.arange(0)
    wanted = forces_of([*settings["dilatancy_loads"], settings["map_load"]], area)
    return np.flatnonzero(np.isin(forces, wanted))


def choices(curves, dilatancy, settings, solver):
    """What was chosen for a specimen, why, and what error it makes.

    Parameters
    ----------
    curves : xr.Dataset
        From :func:`mechanics.closure.closure_curves`.
    dilatancy : xr.Dataset
        From :func:`mechanics.closure.elastic_dilatancy`.
    settings, solver : dict
        From :mod:`study.configuration`.

    Returns
    -------
    xr.Dataset
        ``value``, ``reason``, ``error_of`` and ``error`` (a share; NaN where there is none) over
        ``choice``; ``asked`` in the attributes.
    """
    solved = curves["solved"]
    asked = solver["accuracy"]
    rows = [
        _of_tolerance(curves, solver, asked),
        _of_loads(curves, dilatancy, asked),
        _of_directions(curves, settings),
        _of_resolutions(curves),
        _of_extent(curves),
    ]
    columns = ("choice", "value", "reason", "error_of")
    words = ("what was chosen", "how", "why", "what the error is of")
    texts = {
        column: ("choice", [row[i] for row in rows], cf_attrs("1", word))
        for i, (column, word) in enumerate(zip(columns, words, strict=True))
    }
    return xr.Dataset(
        {
            **{name: texts[name] for name in columns[1:]},
            "error": (
                "choice",
                np.array([row[-1] for row in rows], float),
                cf_attrs("1", "largest error it is estimated to make, as a share"),
            ),
        },
        coords={"choice": texts["choice"]},
        attrs={
            "asked": _asked(asked),
            "states": int(solved.size),
            "states_solved": int(solved.sum()),
        },
    )


def _asked(accuracy):
    if accuracy is None:
        return "everything: all states, whatever it costs"
    return f"closure to {accuracy['closure']:.3g}, Delta_sigma to {accuracy['delta_sigma']:.3g}"


def _largest(values):
    """Largest value that is known, or NaN."""
    known = values.values[np.isfinite(values.values)]
    return float(known.max(initial=-np.inf)) if known.size else np.nan


def _of_tolerance(curves, solver, asked):
    reason = (
        "stated by the study"
        if asked is None or solver["rtol"] != tolerance(asked)
        else f"{SHARE_OF_CLOSURE:g} of the closure and {SHARE_OF_DIMENSION:g} of the Delta_sigma "
        "asked for: tenfold and more below them where it was tried"
    )
    share = abs(curves["closure_error"] / curves["interface_closure"].where(lambda w: w != 0))
    return "solver tolerance", f"{solver['rtol']:.1g}", reason, "interface closure", _largest(share)


def _of_loads(curves, dilatancy, asked):
    closure = curves["interface_closure"].sel(resolution=curves["resolution"].min())
    misses = dilatancy["left_out_error"].rename(contact_direction="direction")
    shares = abs(misses / closure.where(closure != 0))
    known = shares.values[np.isfinite(shares.values)]
    value = f"{closure.sizes['load']} in the first direction, none read between others"
    if not known.size:
        return "load steps", value, "too few to tell what lies between them", "", np.nan
    within = np.mean(known <= asked["closure"]) if asked else np.nan
    reason = (
        f"left out and read from its neighbours a closure would be wrong by {np.median(known):.1%} "
        f"(median) to {known.max():.0%} of itself"
        + (f"; {within:.0%} would be within what is asked for" if asked else "")
    )
    return "load steps", value, reason, "interface closure, if every second were left out", np.nan


def _of_directions(curves, settings):
    first, *others = settings["contact_directions"]
    if first == "none":
        return "directions", "none", "a surface against a plane does not slide", "", np.nan
    if not others:
        return "directions", first, "the only one whose contact is asked for", "", np.nan
    finest = curves["solved"].sel(resolution=curves["resolution"].min())
    loads = int(finest.sel(direction=others[0]).any("offset").sum())
    value = f"{first}: all loads; {', '.join(others)}: {loads}"
    reason = (
        "the study asks for all"
        if loads == finest.sizes["load"]
        else "in the others only the dilatancy under its loads is shown"
    )
    return "directions", value, reason, "", np.nan


def _of_resolutions(curves):
    solved = curves["solved"].any("load")
    n_curves = solved.sizes["direction"] * solved.sizes["offset"]
    counts = solved.sum(["direction", "offset"])
    value = ", ".join(
        f"{k}: {int(n)} of {n_curves}"
        for k, n in zip(curves["resolution"].values, counts.values, strict=True)
    )
    reason = (
        "curves at the finest give closure and contact; how they change with the resolution is "
        "asked at the offset of the maps"
    )
    return (
        "resolutions (curves)",
        value,
        reason,
        "interface closure, by the spacing",
        _largest(abs(curves["closure_spacing_error"] / curves["interface_closure"])),
    )


def _of_extent(curves):
    extent = curves["extent"].isel(direction=0).sel(resolution=curves["resolution"].min())
    lightest, heaviest = (float(extent.isel(load=i).median("offset")) for i in (0, -1))
    reason = (
        f"a rectangle around the contact takes {lightest:.0%} of the window under the smallest "
        f"load and {heaviest:.0%} under the largest, which costs most"
    )
    value = "equations on the contact set, displacements on the whole window"
    return "extent of the solve", value, reason, "", np.nan
