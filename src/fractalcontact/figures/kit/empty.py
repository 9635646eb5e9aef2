"""Panels without anything to draw: words in place of curves, and axes that can be drawn.

A specimen in full contact has no stiffness of the interface, a plane no spectrum: such a panel says
why, and no figure fails for it.
"""

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from numpy.typing import ArrayLike

#: Words of a panel without closure of the interface.
TOO_FULL = (
    "contact so full, or faces so flush, that the closure of the interface cannot be separated "
    "from that of the blocks"
)
#: Identifier of the words in an empty panel.
MARK = "nothing-to-draw"
#: Length of a line of the words, letters.
_LINE = 48
#: Ends of a logarithmic axis without values.
_ENDS = (0.1, 1.0)
#: Words of a panel whose figure gives no reason.
_NOTHING = "nothing above zero to draw on a logarithmic axis"


def different_reasons(reasons: ArrayLike) -> list[str]:
    """Reasons for missing numbers as the atlas states them, sorted, each once."""
    return [reason for reason in np.unique(np.asarray(reasons).astype(str)).tolist() if reason]


def missing_lines(reasons: ArrayLike, panel: str = "") -> list[str]:
    """Lines of a legend that say why points are missing; empty if none is.

    `panel` is the letter of the panel that lacks them.
    """
    start = f"({panel}): missing" if panel else "missing"
    lines: list[str] = []
    for reason in different_reasons(reasons):
        lines += textwrap.wrap(f"{start}: {reason}", _LINE, subsequent_indent="    ")
    return lines


def say_empty(axes: Axes, reason: str, *, ticks: bool = True) -> None:
    """Write into the middle of a panel why it is empty, long lines broken.

    Ticks are kept where the axes number something even so.
    """
    if not ticks:
        axes.set(xticks=[], yticks=[])
    axes.text(
        0.5,
        0.5,
        "\n".join(textwrap.fill(line, _LINE) for line in reason.splitlines()),
        transform=axes.transAxes,
        ha="center",
        va="center",
        color="0.35",
        bbox={"color": "white"},
        gid=MARK,
    )


def settle_empty_axes(figure: Figure) -> None:
    """Give logarithmic axes without a positive value ends, and their panels words.

    To be called when everything is drawn: matplotlib has no ticks for such an axis, and raises.
    """
    for axes in (axes for axes in figure.axes if axes.axison):
        empty = [axis for axis in (axes.xaxis, axes.yaxis) if _without_values(axis)]
        for axis in empty:
            low, high = axis.get_view_interval()
            if not (0 < low < high and np.isfinite(high)):
                set_ends = axes.set_xlim if axis is axes.xaxis else axes.set_ylim
                set_ends(*_ENDS)
                _without_ticks(axes, axis.axis_name)
        if empty and axes.get_visible() and not any(t.get_gid() == MARK for t in axes.texts):
            say_empty(axes, _NOTHING)


def _without_ticks(axes, name):
    """Remove the numbers of an axis without values, and of its secondary axis."""
    for panel in (axes, *axes.child_axes):
        axis: Axis = getattr(panel, f"{name}axis")
        axis.set_major_locator(NullLocator())
        axis.set_minor_locator(NullLocator())


def _without_values(axis) -> bool:
    return axis.get_scale() == "log" and not np.isfinite(axis.get_minpos())
