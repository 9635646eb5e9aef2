"""Axes of forces and offsets, and labels of logarithmic ones that are short."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import (
    LogLocator,
    MaxNLocator,
    NullFormatter,
    NullLocator,
    StrMethodFormatter,
)
from numpy.typing import ArrayLike

from ...core.text import compact, force_unit


def force_axis(axis: Axis, forces: ArrayLike) -> float:
    """Label an axis of normal forces in the unit that suits all loads of the study (N).

    Returns how many N the unit is: forces are drawn divided by it.
    """
    unit, size = force_unit(float(np.max(forces)))
    axis.set_label_text(f"normal force $F$ ({unit})")
    return size


def offset_axis(axes: Axes, offsets: np.ndarray) -> None:
    """Label offsets v (n,), mm, along x.

    The axis is logarithmic where offsets span a decade, with v = 0 at its left if it is drawn.
    """
    slid = offsets[offsets > 0]
    if slid.size > 1 and slid.max() > 10 * slid.min():
        decades = np.arange(np.floor(np.log10(slid.min())), np.log10(slid.max()) + 1)
        # An axis shorter than two decades would have one or two powers of ten.
        parts = (1, 2, 5) if slid.max() < 100 * slid.min() else (1,)
        places = np.outer(10**decades, parts).ravel()
        within = (places >= slid.min() * (1 - 1e-9)) & (places <= slid.max() * (1 + 1e-9))
        ticks = list(places[within])
        if slid.size < len(offsets):
            axes.set_xscale("symlog", linthresh=slid.min(), linscale=0.3)
            axes.set_xlim(-0.15 * slid.min(), 1.2 * slid.max())
            axes.xaxis.set_minor_locator(NullLocator())
            ticks.insert(0, 0.0)
        else:
            axes.set_xscale("log", nonpositive="mask")
            axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xticks(ticks, [compact(tick, 6) for tick in ticks])
    axes.set_xlabel("offset $v$ (mm)")


def spacing_axis(axes: Axes, spacings: ArrayLike) -> None:
    """Logarithmic axis of the spacing s, mm, with a number at each."""
    axes.set_xscale("log")
    axes.set_xticks(spacings, [compact(spacing) for spacing in np.asarray(spacings)])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("spacing $s$ (mm)")


def second_axis(axes: Axes, factor: float, label: str) -> None:
    """Second axis at the right, of the left one times a factor."""
    ways = (lambda y: np.asarray(y) * factor, lambda y: np.asarray(y) / factor)
    axes.secondary_yaxis("right", functions=ways).set_ylabel(label)


def label_short_span(axis: Axis) -> None:
    """Number a logarithmic axis shorter than two decades at 1, 2 and 5, in plain digits.

    Powers of ten would be one or none there, and labels of minor ticks would overlap. To be called
    when everything is drawn.
    """
    low, high = axis.get_view_interval()
    axis.set_minor_formatter(NullFormatter())
    if high < 100 * low:
        axis.set_major_locator(_FewPlaces(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))


class _FewPlaces(LogLocator):
    """Places at 1, 2 and 5; where fewer than two of them lie on the axis, up to four even ones.

    Matplotlib takes up to nine even ones there, whose labels overlap.
    """

    def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
        low, high = sorted((vmin, vmax))
        decades = 10 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
        places = np.outer(decades, (1, 2, 5)).ravel()
        inside = places[(places >= low * (1 - 1e-9)) & (places <= high * (1 + 1e-9))]
        if inside.size > 1:
            return inside.tolist()
        return list(MaxNLocator(3, steps=[1, 2, 5, 10]).tick_values(low, high))
