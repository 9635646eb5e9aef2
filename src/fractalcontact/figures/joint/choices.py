"""Solve plan of a specimen: states solved, accuracy, reasons."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing
from ..kit.tables import LINE_HEIGHT, draw_rows, wrap_rows
from ..kit.titles import headline
from ..kit.words import percent, place

TITLE = "Solve plan: which states were solved, how exactly, and why"
SUBJECT = "specimen"
NEEDS = ("choices", "closure")
ORDER = 220

#: Columns of the table: where they begin, in fractions of the width, and the letters they hold.
COLUMNS = {"choice": (0.0, 18), "value": (0.155, 32), "reason": (0.42, 56), "error": (0.86, 18)}
HEADS = {"choice": "Choice", "value": "Value", "reason": "Reason", "error": "Largest error"}
NO_ERROR = "–"


def draw(atlas: DataTree, name: str) -> Drawing:
    """The solve plan as a table."""
    subject = Subject.of(atlas, name)
    plan = subject["choices"]
    table = _table(plan)
    texts, lines = wrap_rows(table.to_dict("records"), COLUMNS)
    height = LINE_HEIGHT * (sum(lines) + 2.5)
    figure = Figure(figsize=(WIDTH, height + 0.4))
    axes = figure.subplots()
    axes.set_ylim(height / LINE_HEIGHT, 0)
    draw_rows(axes, texts, lines, COLUMNS, HEADS, 0.4)
    headline(figure, subject.label, place(subject.direction))
    states = {key: plan.attrs[key] for key in ("states", "states_solved")}
    words = {str(key): plan[key].item() for key in plan.data_vars if not plan[key].dims}
    return Drawing(figure, table, caption(__name__, **words, **states))


def _table(plan):
    """Rows of the table as text; the first states the requested accuracy and what it leaves out."""
    table = plan[["choice", "value", "reason"]].to_dataframe().reset_index().astype(str)
    table["error"] = [
        f"{percent(error)} of the {of}" if np.isfinite(error) else NO_ERROR
        for error, of in zip(plan["error"].values, plan["error_of"].values, strict=True)
    ]
    solved, states = (plan.attrs[key] for key in ("states_solved", "states"))
    left_out = "" if solved == states else "; the others are missing in the atlas"
    value, reason = f"{solved} of {states} solved", f"asked: {plan.attrs['asked']}{left_out}"
    first = {"choice": "states", "value": value, "reason": reason, "error": NO_ERROR}
    return pd.concat([pd.DataFrame([first]), table[list(first)]], ignore_index=True)
