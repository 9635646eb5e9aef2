"""The errors that the atlas states for its states, the largest of all offsets."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import (
    COLOURS,
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    entries,
    group,
    headline,
    legends_below,
    settings_of,
)
from ..kit.words import SUPPLEMENTARY, force_label, percent, place

TITLE = "Largest errors of all offsets: by the solver, and by the spacing"
SUBJECT = "specimen"
NEEDS = ("choices", "closure", "domains")
ORDER = 221

#: Errors drawn: stage, variable, its error, whether relative to it, and the words of the legend.
ERRORS = (
    ("closure", "interface_closure", "interface_closure_error", True, "interface closure"),
    ("closure", "area", "area_error", True, "real contact area"),
    ("closure", "interface_stiffness", "interface_stiffness_error", True, "interface stiffness"),
    ("domains", "delta_sigma", "delta_sigma_error", False, "$\\Delta_\\sigma$ (absolute)"),
    (
        "closure",
        "interface_closure",
        "closure_spacing_error",
        True,
        "closure, by twice the spacing",
    ),
)
#: What is stated to be exact is drawn here.
LEAST = 1e-8


def draw(atlas: DataTree, name: str) -> Drawing:
    """The largest error of each quantity over the load, at the finest resolution."""
    settings = settings_of(atlas, name)
    direction = settings["contact_directions"][0]
    errors = _errors(atlas, name, direction)
    figure = Figure(figsize=(WIDTH, 3.7))
    axes = figure.subplots()
    _draw_errors(axes, errors)
    legends_below(figure, entries(axes)[::2], entries(axes)[1::2])
    headline(figure, settings["label"], place(direction))
    return Drawing(figure, errors, _caption(errors))


def _errors(atlas, name, direction):
    """Median and largest error over the offsets under each load, at the finest resolution."""
    rows = []
    for stage, variable, key, relative, words in ERRORS:
        states = group(atlas, stage, name)[[variable, key]].sel(direction=direction)
        states = states.sel(resolution=states["resolution"].min())
        errors = states[key] / abs(states[variable]) if relative else states[key]
        for load in errors["normal_force"].values:
            here = errors.sel(normal_force=load).values
            known = here[np.isfinite(here)]
            if known.size:
                row = {"quantity": words, "force_N": load, "offsets": known.size}
                rows.append(row | {"median": np.median(known), "largest": known.max()})
    return pd.DataFrame(rows)


def _draw_errors(axes, errors):
    for i, (words, rows) in enumerate(errors.groupby("quantity", sort=False)):
        style = {"color": COLOURS[i], "marker": MARKERS[i], "ls": LINES[i % len(LINES)]}
        drawn = np.maximum(rows["largest"], LEAST)
        axes.plot(rows["force_N"], drawn, label=words, **style)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("normal force $F$ (N)")
    axes.set_ylabel("largest relative error (1)")
    axes.set_title(f"errors of {LEAST:g} and less stand at the bottom", loc="left")


def _caption(errors):
    solver = errors[errors["quantity"] != ERRORS[-1][-1]]
    worst = solver.loc[solver["largest"].idxmax()]
    spacing = errors[errors["quantity"] == ERRORS[-1][-1]]["largest"]
    by_spacing = ""
    if len(spacing):
        ends = " to ".join(dict.fromkeys(percent(end) for end in (spacing.min(), spacing.max())))
        by_spacing = f"; twice the spacing changes the closure by {ends}"
    return (
        f"{SUPPLEMENTARY} Largest error of each quantity under each load. The largest by the "
        f"solver is {worst['largest']:.2g}, of the {worst['quantity']} at "
        f"{force_label(worst['force_N'])}{by_spacing}."
    )
