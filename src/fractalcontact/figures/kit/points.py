"""Points of figures with error bars, filled where they are trusted and open elsewhere."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

#: Style of a legend's entry that stands for points of every colour.
_ANY = {"color": "0.4", "marker": "o"}


def reach(value: ArrayLike, low: ArrayLike, high: ArrayLike) -> np.ndarray:
    """Lengths (2, n) of error bars below and above values, as matplotlib's ``xerr`` and ``yerr``.

    Ends of an interval that are NaN draw no bar. Lengths are at least 0: rounding may put the
    interval of an exact fit beside its value, and matplotlib raises on a negative length.
    """
    value, low, high = (np.atleast_1d(np.asarray(one, float)) for one in (value, low, high))
    return np.maximum([value - low, high - value], 0)


def draw_points(
    axes: Axes,
    x: ArrayLike,
    y: ArrayLike,
    filled: ArrayLike,
    hollow: Mapping[str, Any] | None = None,
    **style: Any,
) -> None:
    """Points, filled where they are trusted and hollow elsewhere.

    A line style ``ls`` joins all points; the label is that of the filled ones. `hollow` is the
    style that hollow points have besides, or in place of a white face.
    """
    x, y, filled = np.asarray(x), np.asarray(y), np.asarray(filled, bool)
    style = {"ls": "none"} | style
    joined = style["ls"] != "none"
    # A line is drawn in one piece with all its markers, which hollow ones then cover.
    first = filled | joined
    axes.plot(x[first], y[first], **style)
    unlabelled = {key: value for key, value in style.items() if key != "label"}
    face = {"ls": "none", "mfc": "white"}
    axes.plot(x[~filled], y[~filled], **unlabelled | face | dict(hollow or {}))


def hollow_entry(axes: Axes, label: str, **style: Any) -> None:
    """Legend entry of hollow points; grey unless a style is given, for those of every colour."""
    axes.plot([], [], label=label, **{**_ANY, **style, "ls": "none", "mfc": "white"})
