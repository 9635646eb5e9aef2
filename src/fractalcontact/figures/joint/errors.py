"""Error of each published quantity against load, split by source."""

import re

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
    force_axis,
    group,
    headline,
    label_short_span,
    letter,
    nearest_load,
    settings_of,
)
from ..kit.sizes import plain_decades
from ..kit.words import SUPPLEMENTARY, force_label, length_unit, percent, place, short

TITLE = "Error of each quantity by source"
SUBJECT = "specimen"
NEEDS = ("error_budget", "specimens")
ORDER = 225

#: Quantities: title of the panel, and its word in the caption.
QUANTITIES = {
    "closure": "interface closure",
    "separation": "separation",
    "area_corrected": "real contact area, corrected",
    "stiffness": "tangent stiffness",
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
    "resolution": "every second node: another surface, in no total",
}
TOTALS = {
    "total": ("total for this very surface\n(solver, numerical, estimator)", "-"),
    "total_of_population": (
        "total for any surface of its kind\n(also counting or windows, registration)",
        "--",
    ),
}
INTERPOLATED = "numerical, interpolated between loads"
#: What is smaller is drawn here: as a fraction of the value, and where errors are in the unit of
#: the quantity as one of the largest error drawn.
LEAST = 1e-4
#: Totals less than this factor apart lie on each other.
_APART = 1.05


def draw(atlas: DataTree, name: str) -> Drawing:
    """Errors over the load at the map offset, one panel a quantity, one line a source."""
    settings, budget = settings_of(atlas, name), group(atlas, "error_budget", name)
    table = _table(budget)
    figure = Figure(figsize=(WIDTH, 6.6))
    panels = figure.subplots(3, 2, sharex=True).ravel()
    specimen = group(atlas, "specimens", name)
    forces = budget["normal_force"].values
    load = nearest_load(forces, settings["map_load"], specimen)
    here = budget.isel(normal_force=load)
    cut = False
    for i, (quantity, title) in enumerate(QUANTITIES.items()):
        axes = panels[i]
        size = force_axis(axes.xaxis, forces)
        axes.axvline(forces[load] / size, color="0.8", lw=3, zorder=0, label=_of_maps(here))
        of_quantity = here.sel(quantity=quantity)
        drawn, unit = _drawn(table[table["quantity"] == quantity], of_quantity)
        cut |= bool(drawn["cut"].any())
        _draw_errors(axes, drawn, size)
        letter(axes, "abcde"[i], f"{title}: {_totals_words(of_quantity)}")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylabel(f"error, 95 % ({unit})")
        if i < len(QUANTITIES) - 2:
            axes.set_xlabel("")
        else:
            axes.tick_params(labelbottom=True)
    _scale_errors([panels[i] for i, name in enumerate(QUANTITIES) if not _absolute(here, name)])
    for axes in panels[:-1]:
        plain_decades(axes.yaxis)
    label_short_span(panels[0].xaxis)
    figure.align_ylabels(panels[:-1])
    _draw_legend(panels[-1], panels[:-1], cut=cut)
    direction, offset = budget.attrs["direction"], budget.attrs["offset_mm"]
    headline(figure, settings["label"], place(direction, offset))
    return Drawing(figure, table, _caption(here))


def _absolute(budget, quantity) -> bool:
    """Whether errors of a quantity are in its unit alone."""
    return bool(budget["absolute"].sel(quantity=quantity))


def _scale_errors(panels) -> None:
    """One scale for all errors that are fractions: they can be compared."""
    low, high = zip(*(axes.get_ylim() for axes in panels), strict=True)
    for axes in panels:
        axes.set_ylim(min(70 * LEAST, *low), max(high))


def _words(of_quantity, error) -> str:
    """An error of a quantity in words: a fraction of the value, or in the unit."""
    value = float(of_quantity["published"])
    if value and not of_quantity["absolute"]:
        return percent(float(error) / abs(value))
    if str(of_quantity["unit"].values) != "mm":
        return short(float(error), 2)
    unit, size = length_unit(float(error))
    return f"{short(float(error) / size, 2)} {unit}"


def _totals_words(of_quantity) -> str:
    """Both totals at the load of the maps, for the title of a panel."""
    own, kind = (float(of_quantity[key]) for key in TOTALS)
    if not np.isfinite(own):
        return "total not known"
    words = [_words(of_quantity, error) for error in (own, kind)]
    if not np.isfinite(kind):
        return f"total {words[0]}"
    if _coincide(own, kind):
        return f"both totals {' to '.join(dict.fromkeys(words))}"
    return f"totals {', '.join(words)}"


def _coincide(own, kind) -> bool:
    """Whether the lines of both totals lie on each other."""
    return bool(kind < _APART * own)


def _of_maps(here) -> str:
    """Entry of the legend for the load whose totals stand above the panels."""
    force = force_label(float(here["normal_force"]))
    return f"load of the totals above the panels\n(of this surface, of its kind): {force}"


def _table(budget) -> pd.DataFrame:
    """Errors drawn, one row a quantity, source and load."""
    rows = []
    for quantity in QUANTITIES:
        of_quantity = budget.sel(quantity=quantity)
        lines = {key: of_quantity["error"].sel(source=key) for key in SOURCES}
        lines |= {key: of_quantity[key] for key in TOTALS}
        fractions = {key: of_quantity["relative_error"].sel(source=key) for key in SOURCES}
        fractions |= {key: of_quantity[f"relative_{key}"] for key in TOTALS}
        for source, errors in lines.items():
            if not (errors > 0).any():
                continue
            for i, force in enumerate(budget["normal_force"].values):
                rows.append(
                    {
                        "quantity": quantity,
                        "source": source,
                        "force_N": force,
                        "error": float(errors[i]),
                        "unit": str(of_quantity["unit"].values),
                        "relative_error": float(fractions[source][i]),
                        "numerical_from": str(of_quantity["numerical_from"].values[i]),
                    }
                )
    columns = ["quantity", "source", "force_N", "error", "unit", "relative_error"]
    return pd.DataFrame(rows, columns=[*columns, "numerical_from"])


def _drawn(table, of_quantity) -> tuple[pd.DataFrame, str]:
    """Known errors of a quantity as they are drawn, none below the bottom; and their unit."""
    if of_quantity["absolute"]:
        largest, unit = table["error"].max(), str(of_quantity["unit"].values)
        unit, size = length_unit(largest) if unit == "mm" else (unit, 1.0)
        errors, least = table["error"] / size, LEAST * largest / size
    else:
        errors, least, unit = 100 * table["relative_error"], 100 * LEAST, "% of the value"
    drawn = table.assign(drawn=errors.clip(lower=least), cut=errors <= least)
    return drawn.dropna(subset="drawn"), unit


def _draw_errors(axes, table, size) -> None:
    for i, (source, words) in enumerate(SOURCES.items()):
        rows = table[table["source"] == source]
        if rows.empty:
            continue
        in_totals = source != "resolution"
        style = {"color": colour_of(i + 1) if in_totals else "0.55", "ms": 3.5, "lw": 0.9}
        style |= {"marker": MARKERS[i + 1], "ls": LINES[i % 3] if in_totals else ":"}
        (line,) = axes.plot(rows["force_N"] / size, rows["drawn"], label=words, **style)
        if source == "numerical":
            between = rows["numerical_from"].str.startswith("interpolated")
            style |= {"ls": "none", "mfc": "white", "zorder": line.get_zorder() + 1}
            x = rows["force_N"][between] / size
            axes.plot(x, rows["drawn"][between], label=INTERPOLATED, **style)
    for source, (words, line) in TOTALS.items():
        rows = table[table["source"] == source]
        style = {"color": "black", "lw": 2.2, "ls": line, "zorder": 1}
        axes.plot(rows["force_N"] / size, rows["drawn"], label=words, **style)


def _draw_legend(axes, panels, *, cut: bool) -> None:
    """Every line of any panel, in the place of a panel."""
    axes.set_axis_off()
    found = {entry.get_label(): entry for panel in panels for entry in entries(panel)}
    of_maps = [label for label in found if str(label).startswith("load of")]
    order = [*SOURCES.values(), INTERPOLATED, *(words for words, _ in TOTALS.values()), *of_maps]
    axes.legend(
        handles=[found[words] for words in order if words in found],
        loc="center",
        title="lowest points of a panel: such errors and smaller ones" if cut else None,
        title_fontsize=7,
        handlelength=3.5,
    )


def _kind_words(here) -> str:
    """In which panels the total is larger for any surface of its kind, and what adds most there."""
    letters, added = [], []
    for which, quantity in zip("abcde", QUANTITIES, strict=True):
        of_quantity = here.sel(quantity=quantity)
        own, kind = (float(of_quantity[key]) for key in TOTALS)
        if np.isfinite([own, kind]).all() and not _coincide(own, kind):
            errors = of_quantity["error"].sel(source=["counting", "window"])
            if np.isfinite(errors).any():
                letters.append(f"({which})")
                added.append(str(errors["source"].values[int(np.nanargmax(errors))]))
    if not letters:
        return ""
    words = " or ".join(SOURCES[source] for source in dict.fromkeys(added))
    run = "abcde".find(re.sub(r"\W", "", "".join(letters))) >= 0 and len(letters) > 2
    where = f"{letters[0]} to {letters[-1]}" if run else ", ".join(letters)
    return f"; larger in {where} for any surface of its kind ({words})"


def _caption(here) -> str:
    """Sources of error, and the largest at the load of the maps."""
    parts = []
    for quantity, words in WORDS.items():
        of_quantity = here.sel(quantity=quantity)
        total = float(of_quantity["total"])
        if not np.isfinite(total):
            continue
        errors = of_quantity["error"].sel(source=["solver", "numerical", "estimator"])
        largest = str(errors["source"].values[int(np.nanargmax(errors))])
        parts.append(f"{words} {_words(of_quantity, total)} ({largest})")
    found = (
        f"Totals for this surface at {force_label(float(here['normal_force']))} and their largest "
        f"sources: {', '.join(parts)}{_kind_words(here)}."
        if parts
        else "No total is known at the load of the maps."
    )
    return f"{SUPPLEMENTARY} Errors by source, half-widths at 95 %. {found}"
