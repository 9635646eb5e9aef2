"""What the paper says, and whether it holds for this joint: a table."""

from textwrap import fill

import pandas as pd
from matplotlib.figure import Figure

from ..statements import FAILS, HOLDS, PARTLY, UNKNOWN
from ._words import force_label, opening, place
from .common import (
    COLOURS,
    TITLE_SIZE,
    WIDTH,
    Drawing,
    group,
    label_in_lines,
    settings_of,
)

#: A sign for each verdict, so that the table can be read without its colours.
SIGNS = {HOLDS: ("●", COLOURS[3]), PARTLY: ("◐", COLOURS[5])}
SIGNS |= {FAILS: ("○", COLOURS[2]), UNKNOWN: ("–", "0.4")}

#: Where the columns begin, as shares of the width, and how many letters they hold.
COLUMNS = {"figure": (0.01, 8), "claim": (0.065, 46), "verdict": (0.44, 24), "numbers": (0.575, 60)}
LINE_HEIGHT = 0.135  # inches


def draw(atlas, name):
    """The statements, one row each.

    Parameters
    ----------
    atlas : xr.DataTree
    name : str
        A specimen of the atlas.

    Returns
    -------
    Drawing
    """
    label = settings_of(atlas, name)["label"]
    found = group(atlas, "statements", name)
    table = pd.DataFrame({key: found[key].values.astype(str) for key in COLUMNS})
    texts = [
        {key: fill(row[key], COLUMNS[key][1]) for key in COLUMNS} for _, row in table.iterrows()
    ]
    lines = [1 + max(text.count("\n") + 1 for text in row.values()) for row in texts]
    title = label_in_lines(label, width=WIDTH)
    top = 1.3 * title.count("\n")
    height = LINE_HEIGHT * (top + sum(lines) + 4.4)
    figure = Figure(figsize=(WIDTH, height))
    figure.set_layout_engine("none")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(0, 1)
    axes.set_ylim(height / LINE_HEIGHT, 0)
    axes.text(0.5, 0.8, title, ha="center", va="top", fontsize=TITLE_SIZE)
    heads = {"figure": "Fig.", "claim": "The paper says", "verdict": "Here", "numbers": "Because"}
    for key, (x, _) in COLUMNS.items():
        axes.text(x, top + 2.6, heads[key], va="top", weight="bold", fontsize=7)
    y = top + 4.2
    for row, verdict, rows in zip(texts, table["verdict"], lines, strict=True):
        axes.axhline(y - 0.35, color="0.8", lw=0.5)
        for key, (x, _) in COLUMNS.items():
            axes.text(x, y, row[key], va="top", fontsize=7, linespacing=1.15)
        sign, colour = SIGNS[verdict]
        axes.text(0.42, y, sign, va="top", color=colour, fontsize=8, family="DejaVu Sans")
        y += rows
    return Drawing(figure, table, _caption(label, found, table))


def _caption(label, found, table):
    counts = table["verdict"].value_counts()
    summary = ", ".join(
        f"{counts[key]} {_noun(key, counts[key])}" for key in SIGNS if key in counts
    )
    return (
        f"{opening('the statements', label, place(found.attrs['direction']))} Of {len(table)} "
        f"statements {summary}. Judged by rules of our own, which the paper does not give, and "
        f"where a load is needed at F = {force_label(found.attrs['force'])}."
    )


def _noun(verdict, count):
    words = {HOLDS: "hold", PARTLY: "hold in part", FAILS: "do not hold", UNKNOWN: "cannot be told"}
    single = {HOLDS: "holds", PARTLY: "holds in part", FAILS: "does not hold"}
    return single.get(verdict, words[verdict]) if count == 1 else words[verdict]
