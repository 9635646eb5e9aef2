"""What was solved and how exactly, and why."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import WIDTH, Drawing, group, headline, settings_of
from ..kit.tables import LINE_HEIGHT, draw_rows, wrap_rows
from ..kit.words import SUPPLEMENTARY, percent, place

TITLE = "Solve plan: which states were solved, how exactly, and why"
SUBJECT = "specimen"
NEEDS = ("choices",)
ORDER = 220

#: Columns of the table: where they begin, in fractions of the width, and the letters they hold.
COLUMNS = {"choice": (0.0, 18), "value": (0.155, 32), "reason": (0.42, 56), "error": (0.86, 18)}
HEADS = {"choice": "Choice", "value": "Value", "reason": "Reason", "error": "Largest error"}
#: What an error of the plan is called: one is of another surface.
_SPACINGS = {
    "by the spacing": "by every second node (another surface)",
    "by the grid": "by the grid (same surface)",
}
#: Of what the errors are that the caption compares, as the plan has it.
_BY_SOLVER, _BY_GRID = "interface closure", "interface closure, by the grid"


def draw(atlas: DataTree, name: str) -> Drawing:
    """The solve plan as a table."""
    settings = settings_of(atlas, name)
    plan = group(atlas, "choices", name)
    table = [_states(plan), *_table(plan)]
    texts, lines = wrap_rows(table, COLUMNS)
    height = LINE_HEIGHT * (sum(lines) + 2.5)
    figure = Figure(figsize=(WIDTH, height + 0.4))
    axes = figure.subplots()
    axes.set_ylim(height / LINE_HEIGHT, 0)
    draw_rows(axes, texts, lines, COLUMNS, HEADS, 0.4)
    headline(figure, settings["label"], place(settings["contact_directions"][0]))
    return Drawing(figure, pd.DataFrame(table), _caption(plan))


def _states(plan):
    """First row of the table: what was asked, and how many states that left out."""
    solved, states = int(plan.attrs["states_solved"]), int(plan.attrs["states"])
    return {
        "choice": "states",
        "value": f"{solved} of {states} solved",
        "reason": f"asked: {plan.attrs['asked']}"
        + ("" if solved == states else "; the others are missing in the atlas"),
        "error": "–",
    }


def _table(plan):
    """Rows of the table, all as text."""
    rows = []
    for i, choice in enumerate(plan["choice"].values):
        error = float(plan["error"][i])
        of = str(plan["error_of"].values[i])
        for words, plain in _SPACINGS.items():
            of = of.replace(words, plain)
        rows.append(
            {
                "choice": str(choice),
                "value": str(plan["value"].values[i]),
                "reason": str(plan["reason"].values[i]),
                "error": f"{percent(error)} of the {of}" if np.isfinite(error) else "–",
            }
        )
    return rows


def _caption(plan):
    solved, states = plan.attrs["states_solved"], plan.attrs["states"]
    return (
        f"{SUPPLEMENTARY} Solve plan with the reason for each choice: {solved} of {states} states "
        f"were solved.{_error_words(plan)}"
    )


def _error_words(plan):
    """What limits the accuracy of the closure: the solver or the grid."""
    of = [str(words) for words in plan["error_of"].values]
    known = {words: float(plan["error"].values[of.index(words)]) for words in of if words}
    solver, grid = (known.get(words, np.nan) for words in (_BY_SOLVER, _BY_GRID))
    if not np.isfinite([solver, grid]).all():
        return ""
    limits = "grid" if grid > solver else "solver"
    return (
        f" The {limits} limits the accuracy: the grid's error (same surface) is up to "
        f"{percent(grid)} of the closure, the solver's {percent(solver)}."
    )
