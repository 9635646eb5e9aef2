"""Table of the paper's statements with their verdicts for one joint."""

from textwrap import fill

import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED
from ..kit.caption import caption
from ..kit.drawing import COLOURS, WIDTH, Drawing
from ..kit.panel import rows
from ..kit.tables import LINE_HEIGHT, draw_rows, wrap_rows
from ..kit.titles import TITLE_SIZE, label_in_lines
from ..kit.verdicts import CIRCULAR_SHORT
from ..kit.words import force_label

TITLE = "Statements of the paper, and whether they hold"
SUBJECT = "specimen"
NEEDS = ("statements",)
ORDER = 210

#: A sign for each verdict, so that the table can be read without its colours.
SIGNS = {HOLDS: ("●", COLOURS[3]), PARTLY: ("◐", COLOURS[5]), FAILS: ("○", COLOURS[2])}
SIGNS |= {UNDETERMINED: ("?", "0.4"), ILL_POSED: ("×", "0.4")}

#: Columns of the data, and where those drawn begin, as fractions of the width, with their letters.
DATA = (
    *("figure", "claim", "verdict", "circular", "numbers", "note"),
    *("judged_on", "circular_reason"),
)
COLUMNS = {"figure": (0.01, 8), "claim": (0.075, 44), "verdict": (0.44, 16), "numbers": (0.56, 57)}


#: What the symbols of the table are, below it, and letters of a line.
SYMBOLS = (
    "Brackets: 95 % intervals. F normal force, sigma_0 nominal pressure, sigma_n real and sigma* "
    "fractal mean pressure, v offset, b side of the window, s spacing, w and w_int closure, "
    "delta_r rigid dilatancy, A_r real and A_0 nominal contact area, Delta_g dimension of the "
    "surface, Delta_sigma of the contact domain, "
    "h'_rms rms slope, sigma_z roughness, e and m exponents, c and d constants, r2 squared "
    "correlation."
)
SYMBOL_LETTERS = 136


def draw(atlas: DataTree, name: str) -> Drawing:
    """The statements, one row each."""
    subject = Subject.of(atlas, name)
    judged = subject["statements"]
    table = rows(judged, *DATA)[list(DATA)]
    force = float(judged.attrs["force"])
    words = {"counts": table["verdict"].value_counts().to_dict(), "verdicts": tuple(SIGNS)}
    words |= {"circular": int(table["circular"].sum()), "force": force}
    return Drawing(draw_table(table, subject.label, force), table, caption(__name__, **words))


def draw_table(table: pd.DataFrame, label: str, force: float) -> Figure:
    """Figure of a table of statements, one row each under a title.

    Parameters
    ----------
    table : pd.DataFrame
        Columns :data:`DATA`.
    label : str
        The title.
    force : float
        Load at which what no row says otherwise is judged, N.
    """
    texts, lines = wrap_rows([_texts(row) for row in table.to_dict("records")], COLUMNS)
    title = label_in_lines(label, width=WIDTH)
    top = 1.3 * title.count("\n")
    judged_at = f"Judged at F = {force_label(force)} unless a row says otherwise. "
    symbols = fill(judged_at + SYMBOLS, SYMBOL_LETTERS)
    below = symbols.count("\n") + 1.5
    height = LINE_HEIGHT * (top + sum(lines) + 4.4 + below)
    figure = Figure(figsize=(WIDTH, height))
    figure.set_layout_engine("none")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_ylim(height / LINE_HEIGHT, 0)
    axes.text(0.5, 0.8, title, ha="center", va="top", fontsize=TITLE_SIZE)
    heads = {"figure": "Fig.", "claim": "The paper states", "verdict": "Here", "numbers": "Reason"}
    places = draw_rows(axes, texts, lines, COLUMNS, heads, top + 2.6)
    for y, verdict in zip(places, table["verdict"], strict=True):
        sign, colour = SIGNS[verdict]
        axes.text(0.42, y, sign, va="top", color=colour, fontsize=8, family="DejaVu Sans")
    axes.axhline(height / LINE_HEIGHT - below - 0.9, color="0.8", lw=0.5)
    y = height / LINE_HEIGHT - below - 0.5
    axes.text(0.01, y, symbols, va="top", fontsize=6.5, color="0.25", linespacing=1.15)
    return figure


def _texts(row):
    """The words of a row: its verdict with the mark of a circular one, all its reasons in one."""
    circular = bool(row["circular"])
    reasons = [row["numbers"], row["note"]]
    reasons += [f"chosen for it: {row['circular_reason']}"] if circular else []
    verdict = f"{row['verdict']}, {CIRCULAR_SHORT}" if circular else row["verdict"]
    return {
        "figure": row["figure"],
        "claim": row["claim"],
        "verdict": verdict,
        "numbers": "; ".join(filter(None, reasons)),
    }
