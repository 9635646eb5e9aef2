"""Cache of matplotlib's ticks and text sizes while a figure does not change.

A figure is measured for its layout and drawn into two files. Each time matplotlib asks every axis
for its ticks from three sides and lays every text out anew. The answers are the same, and the files
equal those without this cache byte for byte.
"""

import contextlib
from collections.abc import Iterator
from typing import Any
from weakref import WeakKeyDictionary

from matplotlib.figure import Figure
from matplotlib.text import Text

from .ticks import axes_of


def remember_ticks(figure: Figure) -> None:
    """Find the ticks of each axis once for every size and view that it is given.

    To be called when everything is drawn: later changes of a locator or of labels go unnoticed.
    """
    for _, axis in axes_of(figure):
        vars(axis)["_update_ticks"] = _ticks_remembered(axis)


def _ticks_remembered(axis):
    find, state_of_ticks, ticks_found = axis._update_ticks, None, []

    def ticks():
        nonlocal state_of_ticks, ticks_found
        dpi, bounds = axis.get_figure(root=True).dpi, axis.axes.bbox.bounds
        # Sizes are in inches without the last digits, so that the SVG has the ticks of the PNG.
        # Only the last answer is kept, because matplotlib moves the ticks themselves.
        state = (*axis.get_view_interval(), *(round(side / dpi, 6) for side in bounds))
        if state != state_of_ticks:
            state_of_ticks, ticks_found = state, find()
        return ticks_found

    return ticks


@contextlib.contextmanager
def layouts_remembered() -> Iterator[None]:
    """Every text laid out once on each canvas, within the block."""
    layouts: WeakKeyDictionary[Any, dict] = WeakKeyDictionary()
    lay_out = Text._get_layout  # type: ignore[attr-defined]

    def layout(text, renderer):
        of_canvas = layouts.setdefault(renderer, {})
        state = _state_of(text)
        if state is None:
            return lay_out(text, renderer)
        text_layout = of_canvas.get(state)
        if text_layout is None:
            text_layout = of_canvas[state] = lay_out(text, renderer)
        return text_layout

    setattr(Text, "_get_layout", layout)  # noqa: B010  # a method that types do not know
    try:
        yield
    finally:
        setattr(Text, "_get_layout", lay_out)  # noqa: B010


def _state_of(text):
    """Properties that determine the layout of a text, without its place; None if it wraps."""
    if text.get_wrap():
        return None
    return (
        text.get_text(),
        hash(text.get_fontproperties()),
        text.get_rotation(),
        text.get_rotation_mode(),
        text.get_horizontalalignment(),
        text.get_verticalalignment(),
        text._multialignment,
        text._linespacing,
        text.get_usetex(),
        text.get_parse_math(),
        text.get_figure(root=True).dpi,
    )
