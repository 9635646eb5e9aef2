"""Error of each published quantity against load, split by source."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.labels import REALISATIONS, TWINS
from ...core.subject import Subject
from ...core.text import compact, length_unit, percent
from .. import kit

TITLE = "Error of each quantity by source"
SUBJECT = "specimen"
NEEDS = ("error_budget", "closure")
ORDER = 225
JOINT_STUDY = True

#: Title of the panel of each quantity, and its word in the caption.
QUANTITIES = {
    "closure": ("interface closure", "closure"),
    "separation": ("separation", "separation"),
    "area_corrected": ("contact area", "area"),
    "stiffness": ("tangent stiffness", "stiffness"),
    "delta_sigma": ("$\\Delta_\\sigma$ by boxes", "Δσ"),
}
SOURCES = {
    "solver": "solver",
    "numerical": "numerical (same surface, finer grid)",
    "secant": "scatter of a secant, where nodes yield",
    "counting": "counting of contacts",
    "window": "other windows of the scan",
    "registration": "registration of the faces",
    "resolution": "every second node: another surface, in no total",
    "model": "three times the hardness: other model, in no total",
    "estimator": "ordinary slope: another estimator, in no total",
    TWINS: "twins of the scan, in place of counting, windows",
    REALISATIONS: "realisations, in place of counting, windows",
    "scan": "other readings of the scans",
}
TOTALS = {
    "total": "total for this very surface\n(solver, numerical, secant, scan)",
    "total_of_population": (
        "total for any surface of its kind\n(also counting or windows, registration)"
    ),
}
#: Smallest error in the frame, as a fraction of the value, or of the largest error drawn.
LEAST = 1e-4
_KEPT = ("error", "relative_error", "unit", "numerical_from")


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Errors over the load at the map offset, one panel a quantity, one line a source."""
    subject = Subject.of(atlas, name)
    budget = subject.state("error_budget")
    errors = _with_totals(subject["error_budget"])
    figure = Figure(figsize=(kit.WIDTH, 6.6))
    *places, legend = figure.subplots(3, 2).ravel()
    titles = [title for title, _ in QUANTITIES.values()]
    panels = kit.panels_of(places, titles)
    for panel, quantity in zip(panels, QUANTITIES, strict=True):
        axes, size = panel.axes, kit.force_axis(panel.axes.xaxis, subject.forces)
        load = float(budget["normal_force"]) / size
        axes.axvline(load, label="reference load", color="0.8", lw=3, zorder=0)
        _draw_errors(panel, errors.sel(quantity=quantity), size)
        kit.plain_decades(axes.yaxis)
    kit.hollow_entry(places[-1], "hollow: interpolated between loads", marker=kit.MARKERS[2])
    handles = {entry.get_label(): entry for axes in places for entry in kit.entries(axes)}
    legend.set_axis_off()
    below = "errors below a frame are negligible"
    style: dict[str, Any] = {"handlelength": 3.5, "title_fontsize": 7}
    legend.legend(handles=list(handles.values()), loc="center", title=below, **style)
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset))
    return kit.Drawing(figure, kit.table_of(*panels), kit.caption(__name__, **_words(budget)))


def _with_totals(budget: xr.Dataset) -> xr.Dataset:
    """Errors by source, the totals among the sources, with `at_load`: True if not interpolated."""
    errors = budget[["error", "relative_error", "unit", "absolute", "numerical_from"]]
    totals = [
        budget[[name, f"relative_{name}"]]
        .rename({name: "error", f"relative_{name}": "relative_error"})
        .expand_dims(source=[name])
        for name in TOTALS
    ]
    named = xr.concat([errors, *totals], "source", data_vars="minimal")
    interpolated = np.char.startswith(named["numerical_from"].values.astype(str), "interpolated")
    solved = (named["source"] != "numerical") | ~named["numerical_from"].copy(data=interpolated)
    error = named["error"].assign_attrs(units="1")  # each quantity has its own
    return named.assign(error=error, at_load=solved)


def _draw_errors(panel: kit.Panel, errors: xr.Dataset, size: float) -> None:
    """Errors of a quantity, in per cent of the value or else in the unit of the quantity."""
    name, unit, scale, largest = "relative_error", "% of the value", 0.01, 1.0
    if errors["absolute"]:
        name, unit, largest = "error", str(errors["unit"].values), float(errors["error"].max())
        unit, scale = length_unit(largest) if unit == "mm" else (unit, 1.0)
    for i, (source, words) in enumerate((SOURCES | TOTALS).items()):
        if source in errors["source"] and (errors["error"].sel(source=source) > 0).any():
            in_no_total = source in ("resolution", "model", "estimator")
            style: dict[str, Any] = {
                "color": "0.55" if in_no_total else kit.colour_of(i + 1),
                "marker": kit.MARKERS[(i + 1) % len(kit.MARKERS)],
                "ls": ":" if in_no_total else kit.LINES[i % 3],
            }
            style |= {"ms": 3.5, "lw": 0.9, "hollow": {"zorder": 3}}
            if source in TOTALS:
                line = kit.LINES[list(TOTALS).index(source)]
                style = {"color": "black", "lw": 2.2, "ls": line, "zorder": 1}
            of: dict[str, Any] = {
                "filled": "at_load",
                "unit": (size, scale),
                "keep": _KEPT,
                "label": words,
            }
            panel.curve(errors.sel(source=source), "normal_force", name, **of, **style)
    panel.axes.set(xscale="log", yscale="log", ylabel=f"error, 95 % ({unit})")
    drawn = errors[name].values / scale
    most = np.max(drawn, where=np.isfinite(drawn), initial=LEAST * largest / scale)
    panel.axes.set_ylim(LEAST * largest / scale, 3 * most)


def _words(budget: xr.Dataset) -> dict[str, Any]:
    """Values of the caption: totals for this surface, each with its largest source."""
    totals = []
    for quantity, (_, words) in QUANTITIES.items():
        errors = budget.sel(quantity=quantity)
        total, relative = float(errors["total"]), float(errors["relative_total"])
        if np.isfinite(relative):
            said = percent(relative)
        elif errors["unit"] == "mm":
            unit, size = length_unit(total)
            said = f"{compact(total / size, 2)} {unit}"
        else:
            said = compact(total, 2)
        if np.isfinite(total):
            totals.append((words, said, str(errors["largest_source"].values)))
    return {"totals": totals, "force": float(budget["normal_force"])}
