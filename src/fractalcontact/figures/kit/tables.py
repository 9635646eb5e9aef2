"""Tables of words within figures: wrapped columns, a thin line above each row."""

from collections.abc import Iterable, Mapping, Sequence
from textwrap import fill

from matplotlib.axes import Axes

LINE_HEIGHT = 0.135  # inches
#: Lines that the heads take, and the space above a row.
HEAD, SPACE = 1.6, 0.35


def wrap_rows(
    rows: Iterable[Mapping[str, str]], columns: Mapping[str, tuple[float, int]]
) -> tuple[list[dict[str, str]], list[int]]:
    """Rows with their texts broken into lines that fit, and the lines each row takes.

    Parameters
    ----------
    rows : iterable of mapping of str to str
    columns : dict
        Key to where the column begins, as a fraction of the width, and how many letters it holds.

    Returns
    -------
    texts : list of dict
    lines : list of int
        With an empty one below.
    """
    texts = [{key: fill(row[key], width) for key, (_, width) in columns.items()} for row in rows]
    return texts, [1 + max(text.count("\n") + 1 for text in row.values()) for row in texts]


def draw_rows(
    axes: Axes,
    texts: list[dict[str, str]],
    lines: list[int],
    columns: Mapping[str, tuple[float, int]],
    heads: Mapping[str, str],
    top: float,
) -> list[float]:
    """Draw heads and rows on axes without an axis, whose y is in lines from the top.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    texts, lines, columns
        As of :func:`wrap_rows`.
    heads : dict
        Key to the head of the column.
    top : float
        Where the heads stand.

    Returns
    -------
    list of float
        Where each row stands.
    """
    axes.set_axis_off()
    axes.set_xlim(0, 1)
    for key, (x, _) in columns.items():
        axes.text(x, top, heads[key], va="top", weight="bold", fontsize=7)
    return draw_texts(axes, texts, lines, columns, top + HEAD)


def draw_texts(
    axes: Axes,
    texts: list[dict[str, str]],
    lines: Sequence[float],
    columns: Mapping[str, tuple[float, int]],
    top: float,
) -> list[float]:
    """Draw rows, a thin line above each, as :func:`draw_rows` does below its heads.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    texts, lines, columns
        As of :func:`wrap_rows`; rows may take less than whole lines.
    top : float
        Where the first row stands.

    Returns
    -------
    list of float
        Where each row stands.
    """
    places, y = [], top
    for row, rows in zip(texts, lines, strict=True):
        axes.axhline(y - SPACE, color="0.8", lw=0.5)
        for key, (x, _) in columns.items():
            axes.text(x, y, row[key], va="top", fontsize=7, linespacing=1.15)
        places.append(y)
        y += rows
    return places
