"""Statements of the paper over all specimens of a study: a table of verdicts."""

from collections.abc import Sequence
from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.claims import claims_of
from ...core.labels import printable
from ...core.subject import configuration_of
from ..joint.statements import DATA, SIGNS
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing, group
from ..kit.line_breaks import in_lines, width_of
from ..kit.tables import LINE_HEIGHT, draw_texts, wrap_rows
from ..kit.words import formulas

TITLE = "Statements of the paper over the specimens of the study"
SUBJECT = "study"
NEEDS = ("statements", "study_statements")
KEY = "defaults"
ORDER = 5

#: Where the columns of words begin and end, as fractions of the width, and their letters.
COLUMNS = {"figure": (0.01, 12), "claim": (0.1, 58)}
FIRST, LAST = 0.53, 0.99
#: Of a specimen's label, upright: points of its letters, inches that a line is long and wide, how
#: many letters a line holds of usual ones, and lines at most.
LABEL_SIZE, LABEL_LENGTH, LABEL_LINE, LETTERS, LABEL_LINES = 7, 1.55, 0.13, 24, 3
#: What stands where a statement is not asked of a specimen, in the key, and its colour.
NOT_ASKED = ("–", "not asked of it", "0.7")
#: What each line of a row takes less than in a table with sentences.
LESS = 0.45
#: Group of what is judged for the study as a whole.
WHOLE = "study"


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Signs of the verdicts by specimen, and below them statements on several specimens."""
    if not len(names):  # measured contact maps alone
        words = caption(__name__, **_counted({}, _whole(atlas)))
        return Drawing(Figure(figsize=(WIDTH, 1)), pd.DataFrame(), words)
    tables = {name: _table(atlas, "statements", name) for name in names}
    rows = {
        name: {"figure": claim.figure, "claim": claim.claim}
        for name, claim in claims_of("one").items()
        if any(name in table.index for table in tables.values())
    }
    whole = _whole(atlas)
    shown = [*rows.values(), *whole[["figure", "claim"]].to_dict("records")]
    texts, lines = wrap_rows([row | {"figure": _place(row["figure"])} for row in shown], COLUMNS)
    texts = [{key: formulas(text) for key, text in row.items()} for row in texts]
    heights = [n - LESS for n in lines]
    heads = _heads(atlas, list(tables))
    top = 1 + max(width_of(head, LABEL_SIZE) for head in heads.values()) / LINE_HEIGHT
    height = LINE_HEIGHT * (top + sum(heights) + 3.2)
    figure = Figure(figsize=(WIDTH, height))
    figure.set_layout_engine("none")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, 1), ylim=(height / LINE_HEIGHT, 0))
    axes.set_axis_off()
    places = draw_texts(axes, texts, heights, COLUMNS, top)
    at = {name: FIRST + (i + 0.5) * (LAST - FIRST) / len(tables) for i, name in enumerate(tables)}
    for name, table in tables.items():
        style: dict[str, Any] = {"rotation": 90, "va": "bottom", "ha": "center", "linespacing": 1}
        axes.text(at[name], top - 0.6, heads[name], fontsize=LABEL_SIZE, **style)
        for statement, y in zip(rows, places, strict=False):
            if statement in table.index:
                row = table.loc[statement]
                _draw_sign(axes, at[name], y, row["verdict"], bool(row["circular"]))
            else:
                sign, _, colour = NOT_ASKED
                axes.text(at[name], y, sign, va="top", ha="center", fontsize=8, color=colour)
    for y, verdict in zip(places[len(rows) :], whole["verdict"], strict=True):
        _draw_sign(axes, FIRST, y, verdict, False, words=f" {verdict} (all together)")
    _draw_key(axes, height / LINE_HEIGHT - 2.7, _counts(tables, whole))
    everything = [table.assign(specimen=name) for name, table in tables.items()]
    data = pd.concat([*everything, whole.assign(specimen="")]).reset_index(names="statement")
    return Drawing(figure, data, caption(__name__, **_counted(tables, whole)))


def _table(atlas, stage, name):
    judged = group(atlas, stage, name)
    return pd.DataFrame({key: judged[key].values for key in DATA}, index=judged["statement"].values)


def _whole(atlas):
    """Statements judged for the study as a whole; empty where it has one specimen."""
    if "study_statements" in atlas.children:
        return _table(atlas, "study_statements", WHOLE)
    return pd.DataFrame({key: [] for key in DATA})


def _draw_sign(axes, x, y, verdict, circular, words=""):
    sign, colour = SIGNS[verdict]
    text = f"{sign}*" if circular else sign
    style = {"va": "top", "fontsize": 8, "family": "DejaVu Sans"}
    axes.text(x, y, text, ha="center", color=colour, **style)
    if words:
        axes.text(x + 0.01, y, words, va="top", fontsize=7)


def _heads(atlas, names):
    """Labels of the specimens in lines, as many as a column is wide."""
    width = (LAST - FIRST) * WIDTH / len(names)
    most = max(1, min(LABEL_LINES, int(width / LABEL_LINE)))
    return {
        name: _head(configuration_of(atlas)["settings"][name]["label"] or name, most)
        for name in names
    }


def _head(label, most):
    """A label in up to ``most`` lines; of a long one the middle is left out."""
    letters = LETTERS * most
    while True:
        text = in_lines(printable(label, letters).replace("$", r"\$"), LABEL_SIZE, LABEL_LENGTH)
        if text.count("\n") < most:
            return text
        letters -= 2


def _place(figures):
    """Figures or section of the paper: "Figs. 4, 5" of "4, 5"."""
    if figures.startswith("sect"):
        return figures
    return f"Fig{'s' if set(figures) & set(',-') else ''}. {figures}"


def _counts(tables, whole):
    """Count of each verdict."""
    return pd.concat([*tables.values(), whole])["verdict"].value_counts()


def _draw_key(axes, y, counts):
    """Legend of the signs with their counts, below the table."""
    style = {"va": "top", "fontsize": 7, "family": "DejaVu Sans"}
    for i, (verdict, (sign, colour)) in enumerate(SIGNS.items()):
        x = 0.01 + 0.2 * i
        axes.text(x, y, sign, color=colour, **style)
        axes.text(x + 0.02, y, f"{verdict}: {counts.get(verdict, 0)}", **style)
    axes.text(0.01, y + 1.2, "*", **style)
    axes.text(0.03, y + 1.2, "circular: the specimen was chosen for it", **style)
    axes.text(0.41, y + 1.2, NOT_ASKED[0], color=NOT_ASKED[2], **style)
    axes.text(0.43, y + 1.2, NOT_ASKED[1], **style)


def _counted(tables, whole):
    """Number of each verdict, and the last statement on all specimens together."""
    verdicts = pd.concat([*tables.values(), whole])
    counts = verdicts["verdict"].value_counts()
    return {
        "specimens": len(tables),
        "counts": [f"{verdict} {counts[verdict]}" for verdict in SIGNS if verdict in counts],
        "circular": int(verdicts["circular"].astype(bool).sum()),
        "last": whole[-1:].to_dict("records"),
    }
