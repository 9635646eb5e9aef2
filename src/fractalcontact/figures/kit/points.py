"""Points of figures with error bars, filled where they are trusted and open elsewhere."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

#: A symbol that stands for those of every colour, in a legend.
_ANY = {"color": "0.4", "marker": "o"}


def reach(value: ArrayLike, low: ArrayLike, high: ArrayLike) -> np.ndarray:
    """Lengths of error bars below and above values, as matplotlib's ``xerr`` and ``yerr``.

    Parameters
    ----------
    value, low, high : float or (n,) array_like
        Values and the ends of their intervals; NaN where there is none, which draws no bar.

    Returns
    -------
    (2, n) ndarray
        At least 0, or NaN. Rounding may leave the interval of an exact fit a hair's breadth beside
        its value, and matplotlib raises on a negative reach.
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

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x, y : (n,) array_like
    filled : (n,) array_like of bool
    hollow : mapping, optional
        What the style of hollow points has besides, or in place of a white face.
    **style
        Of `Axes.plot`. With a line (``ls``) it runs through all points; the label is that of the
        filled ones.
    """
    x, y, filled = np.asarray(x), np.asarray(y), np.asarray(filled, bool)
    style = {"ls": "none"} | style
    joined = style["ls"] != "none"
    # A line is drawn in one piece, with all its markers; the hollow ones hide those below them.
    first = filled | joined
    axes.plot(x[first], y[first], **style)
    unlabelled = {key: value for key, value in style.items() if key != "label"}
    face = {"ls": "none", "mfc": "white"}
    axes.plot(x[~filled], y[~filled], **unlabelled | face | dict(hollow or {}))


def hollow_entry(axes: Axes, label: str, **style: Any) -> None:
    """Legend entry of hollow points.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    label : str
    **style
        Of the points that it stands for; by default grey, for those of every colour.
    """
    axes.plot([], [], label=label, **{**_ANY, **style, "ls": "none", "mfc": "white"})
