"""Legends below a figure, and their entries."""

from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from matplotlib.lines import Line2D


def entries(axes: Axes) -> list[Artist]:
    """Entries of a legend of the axes."""
    return axes.get_legend_handles_labels()[0]


def legends_below(figure: FigureBase, *columns: list[Artist], columnspacing: float = 6) -> None:
    """Legends side by side under a figure, one for each list of entries.

    `columnspacing` is the space between the columns, in letters.
    """
    rows = max(len(column) for column in columns)
    # Matplotlib fills the columns one by one, so that shorter ones are padded.
    handles = [
        handle for column in columns for handle in column + [heading(" ")] * (rows - len(column))
    ]
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=len(columns),
        columnspacing=columnspacing,
        handlelength=3,
    )


def heading(text: str) -> Line2D:
    """Entry of a legend that is words alone."""
    return Line2D([], [], linestyle="none", label=text)


def mark(**style: Any) -> Line2D:
    """Entry of a legend that stands for lines or points of a style; ``label`` has its words."""
    return Line2D([], [], **style)
