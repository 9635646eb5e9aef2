"""Profile of a joint that slid: both faces along the line of sliding, offset and dilatancy."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from ...core.datasets import labelled_dataset
from ...core.directions import axis_and_sign
from ...core.text import compact, length_unit
from ...core.window import faces, window_slices
from .. import kit

#: Marker of the node that touches first.
TOUCH: dict[str, Any] = {
    "marker": "o",
    "ms": 7,
    "mfc": "none",
    "mec": kit.COLOURS[2],
    "mew": 1.5,
    "ls": "none",
}


def way_of(slid: xr.Dataset) -> tuple[str, int]:
    """Axis along which the upper block slides, and the sign of its way there."""
    return axis_and_sign(slid["direction"].item())


def slid_profile(specimen: xr.Dataset, slid: xr.Dataset) -> xr.Dataset:
    """Heights of both faces along the line of sliding through the first touch, mm.

    They go a little beyond the windows before and after.
    """
    axis, sign = way_of(slid)
    along = "yx".index(axis)
    across = "yx"[1 - along]
    (line,) = np.flatnonzero(specimen[across] == slid[f"first_touch_{across}"])
    lower, upper = (np.take(face, line, axis=1 - along) for face in faces(specimen))
    window, cells = window_slices(specimen)[along], sign * int(slid["offset_cells"])
    after = slice(window.start + cells, window.stop + cells)
    # At this lift the upper face touches the lower one in one node.
    lift = np.max(lower[after] - upper[window])
    lifted = np.full((2, lower.size), np.nan)
    lifted[0, window] = upper[window] + lift - float(slid["rigid_dilatancy"])
    lifted[1, after] = upper[window] + lift
    heights = {"lower": lower, "upper_before": lifted[0], "upper_after": lifted[1]}
    table = {face: (axis, "mm", f"height, {face.replace('_', ' ')}") for face in heights}
    first, last = min(window.start, after.start), max(window.stop, after.stop)
    margin = (last - first) // 20
    whole = labelled_dataset(table, heights, coords={axis: specimen[axis]})
    return whole.isel({axis: slice(max(first - margin, 0), last + margin)})


def draw_profile(axes: Axes, profile: xr.Dataset, slid: xr.Dataset, *, before: bool) -> None:
    """Both faces, offset and dilatancy; ``before`` adds the upper face before sliding."""
    axis, sign = way_of(slid)
    offset, opening = float(slid["offset"]), float(slid["rigid_dilatancy"])
    x, lower = profile[axis].values, profile["lower"]
    unit, size = length_unit(x[-1])
    highest = max(float(face.max()) for face in profile.values())
    height_unit, height = length_unit(highest - float(lower.min()))
    axes.plot(x / size, lower / height, color=kit.COLOURS[0], lw=0.9, label="lower face")
    if before:
        style: dict[str, Any] = {"color": kit.COLOURS[1], "lw": 0.7, "ls": "--"}
        label = "upper face at first touch, $v$ = 0"
        axes.plot(x / size, profile["upper_before"] / height, label=label, **style)
    label = r"upper face, slid by $v$ and lifted by $\delta_r$"
    axes.plot(x / size, profile["upper_after"] / height, color=kit.COLOURS[4], lw=0.9, label=label)

    start = float(slid[f"first_touch_{axis}"])
    end = start + sign * offset
    top = float(profile["upper_after"].sel({axis: end}, method="nearest")) / height
    bottom = top - opening / height
    arrow = {"arrowstyle": "<->", "color": kit.COLOURS[3], "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    corner = end / size, bottom
    for tip, tail in ((corner, (start / size, bottom)), ((end / size, top), corner)):
        axes.annotate("", tip, tail, arrowprops=arrow)
    # The numbers stand in the legend: on the profile they would hide it.
    label = rf"offset $v$ = {compact(offset)} mm, dilatancy $\delta_r$ = {compact(opening)} mm"
    axes.plot([], [], color=kit.COLOURS[3], lw=1.2, label=label)
    axes.plot(end / size, top, label="first touch", **TOUCH)
    axes.set_xlabel(f"${axis}$ ({unit})")
    axes.set_ylabel(f"height ({height_unit})")
    axes.margins(x=0, y=0.15)
    floor, ceiling = axes.get_ylim()
    floor = min(floor, bottom - 0.1 * (ceiling - bottom))  # the arrow stays clear of the axis
    axes.fill_between(x / size, lower / height, floor, color="0.9", lw=0, zorder=0)
    axes.set_ylim(floor, ceiling)
