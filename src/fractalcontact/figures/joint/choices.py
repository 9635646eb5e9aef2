"""What was solved and how exactly, why, and the errors that are stated for it."""

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
    letter,
    settings_of,
)
from ..kit.tables import LINE_HEIGHT, draw_rows, wrap_rows
from ..kit.words import SUPPLEMENTARY, percent, place, short

TITLE = "States solved, their accuracy and its reasons, and the errors stated"
SUBJECT = "specimen"
NEEDS = ("choices", "closure", "domains")
ORDER = 220

#: Columns of the table: where they begin, in fractions of the width, and the letters they hold.
COLUMNS = {"choice": (0.0, 18), "value": (0.16, 34), "reason": (0.45, 62), "error": (0.93, 9)}
HEADS = {"choice": "Quantity", "value": "Value", "reason": "Reason", "error": "Error"}

#: Errors drawn: stage, variable, its error, whether relative to it, and the words of the legend.
ERRORS = (
    ("closure", "interface_closure", "interface_closure_error", True, "interface closure"),
    ("closure", "area", "area_error", True, "real contact area"),
    ("closure", "interface_stiffness", "interface_stiffness_error", True, "interface stiffness"),
    ("domains", "delta_sigma", "delta_sigma_error", False, "$\\Delta_\\sigma$ (absolute)"),
    ("closure", "interface_closure", "closure_spacing_error", True, "closure, by the spacing"),
)
#: What is stated to be exact is drawn here.
LEAST = 1e-8


def draw(atlas: DataTree, name: str) -> Drawing:
    """The solve plan as a table, and the errors stated for the states over the load.

    Its data are the rows of the table ("choice") and the errors drawn ("error").
    """
    settings = settings_of(atlas, name)
    plan = group(atlas, "choices", name)
    direction = settings["contact_directions"][0]
    table = _table(plan)
    errors = _errors(atlas, name, direction)
    texts, lines = wrap_rows(table, COLUMNS)
    height = LINE_HEIGHT * (sum(lines) + 2.5)
    figure = Figure(figsize=(WIDTH, height + 3.4))
    above, below = figure.subplots(2, 1, height_ratios=(height, 3.0))
    above.set_ylim(height / LINE_HEIGHT, 0)
    letter(above, "a", "solve plan")
    draw_rows(above, texts, lines, COLUMNS, HEADS, 0.4)
    _draw_errors(below, errors)
    legends_below(figure, entries(below)[::2], entries(below)[1::2])
    headline(figure, settings["label"], place(direction))
    data = pd.concat(
        [pd.DataFrame(table).assign(kind="choice"), errors.assign(kind="error")], ignore_index=True
    )
    return Drawing(figure, data, _caption(settings["label"], plan, errors, direction))


def _table(plan):
    """Rows of the table, all as text."""
    rows = []
    for i, choice in enumerate(plan["choice"].values):
        error = float(plan["error"][i])
        rows.append(
            {
                "choice": str(choice),
                "value": str(plan["value"].values[i]),
                "reason": str(plan["reason"].values[i]),
                "error": f"{float(f'{error:.1g}'):g}" if np.isfinite(error) else "–",
            }
        )
    return rows


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
    axes.set_ylabel("largest error stated,\nrelative (1)")
    letter(axes, "b", f"errors stated in the atlas (those of {LEAST:g} and less at the bottom)")


def _caption(label, plan, errors, direction):
    solver = errors[errors["quantity"] != ERRORS[-1][-1]]
    worst = solver.loc[solver["largest"].idxmax()]
    spacing = errors[errors["quantity"] == ERRORS[-1][-1]]["largest"]
    by_spacing = ""
    if len(spacing):
        least, most = percent(spacing.min()), percent(spacing.max())
        by_spacing = f"; twice the spacing changes the closure by {least} to {most}"
    return (
        f"{SUPPLEMENTARY} (a) Solve plan for the requested accuracy "
        f"({plan.attrs['asked']}); (b) largest errors stated. {plan.attrs['states_solved']} of "
        f"{plan.attrs['states']} states were solved; the others are missing in the atlas. The "
        f"largest solver error is {worst['largest']:.2g}, of the {worst['quantity']} at "
        f"{short(worst['force_N'])} N{by_spacing}."
    )
