"""Layout of a figure, computed once and reused for every file format."""

import numpy as np
from matplotlib.figure import Figure

from .canvas import Canvas
from .empty import settle_empty_axes
from .line_breaks import break_lines
from .remembered import remember_ticks
from .ticks import plain_ticks

#: Digits that places of panels keep, as fractions of the figure.
_DIGITS = 9


def lay_out(figure: Figure) -> Canvas:
    """Find the layout of a finished figure, and keep it.

    Returns the canvas on which the figure was measured: drawing there needs no measuring again. A
    figure that is laid out already stays as it is.
    """
    if isinstance(figure.canvas, Canvas):
        return figure.canvas
    settle_empty_axes(figure)
    canvas = Canvas(figure)
    plain_ticks(figure)
    remember_ticks(figure)
    _place(figure)
    return canvas


def _place(figure):
    """Place the panels, and break words into lines that fit them."""
    layout = figure.get_layout_engine()
    if layout is None:
        return
    # Subfigures need two passes: their margins are fractions of a size that the first one changes.
    for _ in range(2 if figure.subfigs else 1):
        layout.execute(figure)
    # The common factor of the numbers along y takes the place of the title, which moves up.
    crowded = [axes for axes in figure.axes if axes.yaxis.get_offset_text().get_text()]
    for axes in crowded:
        top = axes.yaxis.get_offset_text().get_window_extent().ymax
        y = axes.transAxes.inverted().transform((0, top))[1]
        for loc in ("left", "center"):
            axes.set_title(axes.get_title(loc), loc=loc, y=y)
    if crowded:
        layout.execute(figure)
    while break_lines(figure):
        layout.execute(figure)
    figure.set_layout_engine("none")
    # Places are rounded so that files are the same in every run: the layout's solver takes its
    # constraints in the order of their addresses, which changes the last bits.
    for part in figure.subfigs:
        part.bbox_relative.set_points(np.round(part.bbox_relative.get_points(), _DIGITS))
    for axes in figure.axes:
        axes.set_position(np.round(axes.get_position(original=True).bounds, _DIGITS))
