"""Ticks of matplotlib without its repeated measuring and drawing.

Ticks take half of the time of a figure: each is made, measured twice for the layout, and measured
and drawn once more for either file.
"""

import re
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axes._secondary_axes import SecondaryAxis
from matplotlib.axis import Axis
from matplotlib.figure import FigureBase
from matplotlib.ticker import Locator, LogFormatterSciNotation, NullFormatter, NullLocator

from .axes import label_short_span

_UNLABELLED = {f"label{side}": False for side in ("bottom", "top", "left", "right")}


def plain_ticks(figure: FigureBase) -> None:
    """Number logarithmic axes of a finished figure, and remove invisible parts of its ticks.

    Short axes are numbered by :func:`label_short_span`. Powers of ten become plain text, minor
    ticks are made within the axes alone and drawn as one, and empty labels are not measured.
    """
    for panel, axis in axes_of(figure):
        _spare(panel, axis)


def powers_of_ten(axis: Axis) -> None:
    """Number a logarithmic axis over a decade at powers of ten alone, for a narrow panel."""
    low, high = axis.get_view_interval()
    if high > 10 * low:
        axis.set_major_formatter(_Decades())
        axis.set_minor_formatter(NullFormatter())


def keep_labels(figure: FigureBase) -> None:
    """Keep the labels of all axes where the last drawing placed them, clear of the numbers."""
    for panel, axis in axes_of(figure):
        place = axis.label.get_transform().transform(axis.label.get_position())
        axis.set_label_coords(*panel.transAxes.inverted().transform(place))


def axes_of(figure: FigureBase) -> Iterator[tuple[Axes, Axis]]:
    """Every axis of a figure, secondary ones too, after the panel that it belongs to."""
    drawn: Any = figure  # types do not know the panels of its axes
    for axes in drawn.axes:
        for panel in (axes, *axes.child_axes):
            yield panel, panel.xaxis
            yield panel, panel.yaxis


def _spare(panel, axis):
    if not axis.label.get_text():
        axis.set_label_coords(0, 0)  # otherwise matplotlib also seeks a place for it
    # A secondary axis gets its limits only while it is drawn.
    is_known = not isinstance(panel, SecondaryAxis)
    if is_known and type(axis.get_major_formatter()) is LogFormatterSciNotation:
        label_short_span(axis)
    if type(axis.get_major_formatter()) is LogFormatterSciNotation:  # a long one still
        axis.set_major_formatter(_Decades())
    minor = axis.get_minorticklocs()
    if len(minor):
        axis.set_minor_locator(_Within(axis.get_minor_locator()))
    if not any(axis.get_minor_formatter().format_ticks(minor)):
        panel.tick_params(axis.axis_name, which="minor", **_UNLABELLED)
        if len(minor) and not axis.get_tick_params(which="minor").get("gridOn"):
            vars(axis)["_update_ticks"] = _minor_ticks_as_one(axis)


def _minor_ticks_as_one(axis):
    """Function that finds the ticks of an axis, with one tick for all that have no label."""
    find, none = axis._update_ticks, NullLocator()

    def ticks():
        locator = axis.minor.locator
        places = axis.get_minorticklocs()
        axis.minor.locator = none
        try:
            labelled = find()
        finally:
            axis.minor.locator = locator
        if not len(places):
            return labelled
        (tick,) = axis.get_minor_ticks(1)
        for line in (tick.tick1line, tick.tick2line):
            line.set(**{f"{axis.axis_name}data": places})
        return [*labelled, tick]

    return ticks


class _Decades(LogFormatterSciNotation):
    """Powers of ten as plain text, 10⁻³: as a formula each takes some milliseconds to read."""

    _POWER = re.compile(r"\$\\mathdefault\{10\^\{(-?\d+)\}\}\$")
    _RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

    def __call__(self, x, pos=None):
        text = super().__call__(x, pos)
        power = self._POWER.fullmatch(text)
        return f"10{power[1].translate(self._RAISED)}" if power else text


class _Within(Locator):
    """Ticks of another locator, without those beyond the ends of the axis."""

    def __init__(self, locator):
        self.locator = locator

    def __call__(self):
        low, high = sorted(self.axis.get_view_interval())
        # A tick at the end of the axis is drawn, whatever rounding does to it.
        ticks, slack = np.asarray(self.locator()), 1e-7 * (high - low)
        return ticks[(ticks >= low - min(slack, 1e-7 * abs(low))) & (ticks <= high + slack)]

    def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
        return self.locator.tick_values(vmin, vmax)

    def nonsingular(self, v0: float, v1: float) -> tuple[float, float]:
        return self.locator.nonsingular(v0, v1)

    def view_limits(self, vmin: float, vmax: float) -> tuple[float, float]:
        return self.locator.view_limits(vmin, vmax)
