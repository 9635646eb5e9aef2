"""Error of each published quantity against load, split by source."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import (
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    headline,
    label_short_span,
    letter,
    nearest_load,
    settings_of,
)
from ..kit.words import SUPPLEMENTARY, force_label, percent, place

TITLE = "Error of each quantity by source"
SUBJECT = "specimen"
NEEDS = ("error_budget", "specimens")
ORDER = 225

#: Quantities: title of the panel, and its word in the caption.
QUANTITIES = {
    "closure": "interface closure $w_\\mathrm{int}$",
    "separation": "separation of the mean planes",
    "area_corrected": "corrected area $A_r$",
    "stiffness": "tangent stiffness $\\mathrm{d}\\sigma_0/\\mathrm{d}w_\\mathrm{int}$",
    "delta_sigma": "$\\Delta_\\sigma$ by box counting",
}
WORDS = {
    "closure": "closure",
    "separation": "separation",
    "area_corrected": "area",
    "stiffness": "stiffness",
    "delta_sigma": "Δσ",
}
SOURCES = {
    "solver": "solver",
    "numerical": "numerical (same surface, finer grid)",
    "estimator": "choice of estimator",
    "counting": "counting of contacts",
    "window": "other windows of the scan",
    "registration": "registration of the faces",
    "resolution": "resolution, $2s$ to $s$ (another surface; in no total)",
}
TOTALS = {
    "relative_total": ("total of this surface", "-"),
    "relative_total_of_population": ("total of its population", "--"),
}
INTERPOLATED = "interpolated between loads"
#: What is smaller is drawn here.
LEAST = 1e-4


def draw(atlas: DataTree, name: str) -> Drawing:
    """Relative errors over the load at the map offset, one panel a quantity, one line a source."""
    settings, budget = settings_of(atlas, name), group(atlas, "error_budget", name)
    table = _table(budget)
    figure = Figure(figsize=(WIDTH, 6.6))
    panels = figure.subplots(3, 2, sharex=True).ravel()
    for i, (quantity, title) in enumerate(QUANTITIES.items()):
        axes = panels[i]
        _draw_errors(axes, table[table["quantity"] == quantity])
        letter(axes, "abcde"[i], title)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(bottom=0.7 * LEAST)
        if i % 2 == 0:
            axes.set_ylabel("relative error, 95 % (1)")
        if i >= len(QUANTITIES) - 2:
            axes.set_xlabel("normal force $F$ (N)")
            axes.tick_params(labelbottom=True)
    label_short_span(panels[0].xaxis)
    _draw_legend(panels[-1], panels[:-1])
    direction, offset = budget.attrs["direction"], budget.attrs["offset_mm"]
    where = place(direction, offset)
    headline(figure, settings["label"], where)
    specimen = group(atlas, "specimens", name)
    load = nearest_load(budget["normal_force"].values, settings["map_load"], specimen)
    caption = _caption(budget, load)
    return Drawing(figure, table, caption)


def _table(budget) -> pd.DataFrame:
    """Errors drawn, one row a quantity, source and load."""
    rows = []
    for quantity in QUANTITIES:
        of_quantity = budget.sel(quantity=quantity)
        lines = {key: of_quantity["relative_error"].sel(source=key) for key in SOURCES}
        lines |= {key: of_quantity[key] for key in TOTALS}
        for source, errors in lines.items():
            if not (errors > 0).any():
                continue
            for i, force in enumerate(budget["normal_force"].values):
                rows.append(
                    {
                        "quantity": quantity,
                        "source": source,
                        "force_N": force,
                        "relative_error": float(errors[i]),
                        "numerical_from": str(of_quantity["numerical_from"].values[i]),
                    }
                )
    columns = ["quantity", "source", "force_N", "relative_error", "numerical_from"]
    return pd.DataFrame(rows, columns=columns)


def _draw_errors(axes, table) -> None:
    for i, (source, words) in enumerate(SOURCES.items()):
        rows = table[(table["source"] == source) & np.isfinite(table["relative_error"])]
        if rows.empty:
            continue
        style = {"color": colour_of(i + 1), "marker": MARKERS[i + 1], "ms": 3.5, "lw": 0.9}
        style["ls"] = ":" if source == "resolution" else LINES[i % 3]
        drawn = np.maximum(rows["relative_error"], LEAST)
        (line,) = axes.plot(rows["force_N"], drawn, label=words, **style)
        if source == "numerical":
            between = rows["numerical_from"].str.startswith("interpolated")
            style |= {"ls": "none", "mfc": "white", "zorder": line.get_zorder() + 1}
            axes.plot(rows["force_N"][between], drawn[between], label=INTERPOLATED, **style)
    for source, (words, line) in TOTALS.items():
        rows = table[(table["source"] == source) & np.isfinite(table["relative_error"])]
        drawn = np.maximum(rows["relative_error"], LEAST)
        axes.plot(rows["force_N"], drawn, color="black", lw=2.2, ls=line, label=words, zorder=1)


def _draw_legend(axes, panels) -> None:
    """Every line of any panel, in the place of a panel."""
    axes.set_axis_off()
    found = {entry.get_label(): entry for panel in panels for entry in entries(panel)}
    drawn = np.concatenate([line.get_ydata() for panel in panels for line in panel.lines])
    at_bottom = f"errors of {LEAST:g} and less at the bottom" if (drawn <= LEAST).any() else None
    order = [*SOURCES.values(), INTERPOLATED, *(words for words, _ in TOTALS.values())]
    axes.legend(
        handles=[found[words] for words in order if words in found],
        loc="center",
        title=at_bottom,
        title_fontsize=7,
        handlelength=3.5,
    )


def _caption(budget, load) -> str:
    """Sources of error, and the largest at the load of the maps."""
    here = budget.isel(normal_force=load)
    parts = []
    for quantity, words in WORDS.items():
        of_quantity = here.sel(quantity=quantity)
        total = float(of_quantity["relative_total"])
        if not np.isfinite(total):
            continue
        sources = ["solver", "numerical", "estimator"]
        errors = of_quantity["relative_error"].sel(source=sources)
        largest = str(errors["source"].values[int(np.nanargmax(errors))])
        parts.append(f"{words} {percent(total)} ({largest})")
    found = (
        f"Totals at {force_label(float(here['normal_force']))} and their largest sources: "
        f"{', '.join(parts)}."
        if parts
        else "No total is known at the load of the maps."
    )
    return f"{SUPPLEMENTARY} Errors by source and in all, half-widths at 95 %. {found}"
