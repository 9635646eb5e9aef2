"""The errors that the atlas states for its states, the largest of all offsets."""

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...accuracy.refinement import ABSOLUTE
from ..kit.drawing import (
    COLOURS,
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    entries,
    force_axis,
    group,
    heading,
    headline,
    legends_below,
    settings_of,
)
from ..kit.words import SUPPLEMENTARY, force_label, percent, place, short

TITLE = "Largest errors of all offsets: by the solver, and by the spacing"
SUBJECT = "specimen"
NEEDS = ("choices", "closure", "domains")
ORDER = 221

#: Errors drawn: stage, variable, its error, and the words of the legend.
ERRORS = (
    ("closure", "interface_closure", "interface_closure_error", "interface closure"),
    ("closure", "area", "area_error", "real contact area"),
    ("closure", "interface_stiffness", "interface_stiffness_error", "interface stiffness"),
    ("domains", "delta_sigma", "delta_sigma_error", "$\\Delta_\\sigma$ by box counting, in 0.01"),
    (
        "closure",
        "interface_closure",
        "closure_spacing_error",
        "closure: change by twice the spacing",
    ),
)
#: What is smaller is drawn here.
LEAST = 1e-6
#: Room at the right for a number beside the last point: a third of a decade.
_ROOM = 10 ** (1 / 3)


def draw(atlas: DataTree, name: str) -> Drawing:
    """The largest error of each quantity over the load, at the finest resolution."""
    settings = settings_of(atlas, name)
    direction = settings["contact_directions"][0]
    errors = _errors(atlas, name, direction)
    figure = Figure(figsize=(WIDTH, 3.7))
    axes = figure.subplots()
    _draw_errors(axes, errors, group(atlas, "closure", name)["normal_force"].values)
    drawn = entries(axes)
    by_solver = [one for one in drawn if one.get_label() != ERRORS[-1][-1]]
    by_spacing = [one for one in drawn if one.get_label() == ERRORS[-1][-1]]
    spacing = [heading("by every second node: another surface"), *by_spacing] if by_spacing else []
    legends_below(figure, [heading("by the solver, bounds"), *by_solver], spacing)
    headline(figure, settings["label"], place(direction))
    return Drawing(figure, errors, _caption(errors))


def _errors(atlas, name, direction):
    """Median and largest error over the offsets under each load, at the finest resolution."""
    rows = []
    for stage, variable, key, words in ERRORS:
        states = group(atlas, stage, name)[[variable, key]].sel(direction=direction)
        states = states.sel(resolution=states["resolution"].min())
        size = xr.ones_like(states[variable]) if variable in ABSOLUTE else abs(states[variable])
        errors = states[key] / size.where(size > 0)
        for load in errors["normal_force"].values:
            here = errors.sel(normal_force=load).values
            known = here[np.isfinite(here)]
            if known.size:
                row = {"quantity": words, "force_N": load, "offsets": known.size}
                row["kind"] = "absolute" if variable in ABSOLUTE else "relative"
                rows.append(row | {"median": np.median(known), "largest": known.max()})
    return pd.DataFrame(rows)


def _draw_errors(axes, errors, forces):
    size = force_axis(axes.xaxis, forces)
    for i, (words, rows) in enumerate(errors.groupby("quantity", sort=False)):
        style = {"color": COLOURS[i + 1], "marker": MARKERS[i], "ls": LINES[i % len(LINES)]}
        # Lines that lie on each other stay visible: the later ones are smaller.
        style |= {"ms": 6.5 - i, "lw": 2 - 0.3 * i}
        if words == ERRORS[-1][-1]:
            style = {"color": "0.6", "marker": "x", "ls": "-", "lw": 2.5}
        drawn = 100 * np.maximum(rows["largest"], LEAST)
        axes.plot(rows["force_N"] / size, drawn, label=words, **style)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ymargin(0.12)
    axes.set_ylabel("largest error (% of the value, or in 0.01)")
    axes.set_title(f"at the bottom: errors of {100 * LEAST:g} and less", loc="left")
    _write_ends(axes, errors, size)


def _write_ends(axes, errors, size):
    """The largest solver error, and both ends of those by the spacing, beside their points.

    They stand above their points, that by the solver at the heaviest load at the right of its own:
    there those by the spacing may be near.
    """
    solver, spacing = _by_source(errors)
    quoted = {}
    if len(solver):
        worst = solver["largest"].idxmax()
        quoted[worst] = bool(solver.loc[worst, "force_N"] == solver["force_N"].max())
    if len(spacing):
        quoted |= {spacing["largest"].idxmin(): False, spacing["largest"].idxmax(): False}
    for number, beside in quoted.items():
        row = errors.loc[number]
        at = row["force_N"] / size, 100 * max(row["largest"], LEAST)
        where = {"xytext": (6, 0) if beside else (0, 6), "textcoords": "offset points"}
        where |= {"ha": "left", "va": "center"} if beside else {"ha": "center"}
        axes.annotate(percent(row["largest"]), at, **where)
    low, high = axes.get_xlim()
    axes.set_xlim(low, high * _ROOM)


def _by_source(errors):
    """Errors that are fractions of their values: by the solver, and by the spacing."""
    spaced = errors["quantity"] == ERRORS[-1][-1]
    return errors[~spaced & (errors["kind"] == "relative")], errors[spaced]


def _caption(errors):
    solver, spacing = _by_source(errors)
    worst = solver.loc[solver["largest"].idxmax()]
    absolute = errors.loc[errors["kind"] == "absolute", "largest"].max()
    dimension = f", of Delta_sigma {short(absolute, 2)}" if np.isfinite(absolute) else ""
    by_spacing = ""
    if len(spacing):
        ends = spacing["largest"].min(), spacing["largest"].max()
        words = " to ".join(dict.fromkeys(percent(end) for end in ends))
        by_spacing = f"; twice the spacing changes the closure by {words}"
    return (
        f"{SUPPLEMENTARY} Largest error of each quantity under each load, over all offsets. The "
        f"largest by the solver is {percent(worst['largest'])}, of the "
        f"{worst['quantity']} at {force_label(worst['force_N'])}{dimension}{by_spacing}."
    )
