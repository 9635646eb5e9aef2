"""What was solved and how exactly, and why."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import WIDTH, Drawing, group, headline, settings_of
from ..kit.tables import LINE_HEIGHT, draw_rows, wrap_rows
from ..kit.words import SUPPLEMENTARY, place, short

TITLE = "Solve plan: which states were solved, how exactly, and why"
SUBJECT = "specimen"
NEEDS = ("choices",)
ORDER = 220

#: Columns of the table: where they begin, in fractions of the width, and the letters they hold.
COLUMNS = {"choice": (0.0, 18), "value": (0.155, 32), "reason": (0.42, 56), "error": (0.86, 18)}
HEADS = {"choice": "Quantity", "value": "Value", "reason": "Reason", "error": "Largest error"}


def draw(atlas: DataTree, name: str) -> Drawing:
    """The solve plan as a table."""
    settings = settings_of(atlas, name)
    plan = group(atlas, "choices", name)
    table = _table(plan)
    texts, lines = wrap_rows(table, COLUMNS)
    height = LINE_HEIGHT * (sum(lines) + 2.5)
    figure = Figure(figsize=(WIDTH, height + 0.4))
    axes = figure.subplots()
    axes.set_ylim(height / LINE_HEIGHT, 0)
    draw_rows(axes, texts, lines, COLUMNS, HEADS, 0.4)
    headline(figure, settings["label"], place(settings["contact_directions"][0]))
    return Drawing(figure, pd.DataFrame(table), _caption(plan))


def _table(plan):
    """Rows of the table, all as text."""
    rows = []
    for i, choice in enumerate(plan["choice"].values):
        error = float(plan["error"][i])
        of = str(plan["error_of"].values[i]).split(",")[0]
        rows.append(
            {
                "choice": str(choice),
                "value": str(plan["value"].values[i]),
                "reason": str(plan["reason"].values[i]),
                "error": f"{short(100 * error, 2)} % of the {of}" if np.isfinite(error) else "–",
            }
        )
    return rows


def _caption(plan):
    return (
        f"{SUPPLEMENTARY} Solve plan for the requested accuracy ({plan.attrs['asked']}), with the "
        f"reason for each choice. {plan.attrs['states_solved']} of {plan.attrs['states']} states "
        "were solved; the others are missing in the atlas."
    )
