"""Layout of a figure, computed once and reused for every file format."""

import numpy as np
from matplotlib.figure import Figure

from .canvas import Canvas
from .empty import settle_empty_axes
from .line_breaks import break_lines
from .remembered import remember_ticks
from .ticks import plain_ticks


def lay_out(figure: Figure) -> Canvas:
    """Find the layout of a figure on which everything is drawn, and keep it.

    A figure that is laid out already stays as it is.

    Returns
    -------
    figures.kit.canvas.Canvas
        On which it was measured: what is drawn there needs no measuring again.
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
    """Give panels their places, and words lines that fit them."""
    layout = figure.get_layout_engine()
    if layout is None:
        return
    # Margins of a subfigure are fractions of its size, which the first layout changes.
    for _ in range(2 if figure.subfigs else 1):
        layout.execute(figure)
    # A common factor of the numbers along y stands where a title does, which then moves up.
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
    # The layout's solver takes its constraints in the order of their addresses: the last bits of
    # what it finds differ from run to run, and with them the files.
    for axes in figure.axes:
        axes.set_position(np.round(axes.get_position(original=True).bounds, 9))
