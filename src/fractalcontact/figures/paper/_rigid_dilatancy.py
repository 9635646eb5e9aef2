"""Rigid dilatancy of every direction with the line fitted to its end: a panel of Figs. 6, 7."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist

from ...core.estimate import Estimate
from ...core.limits import LEVEL_CHANGE
from ...core.text import compact, number, percent
from .. import kit

#: Style of the fitted lines.
_FITTED: dict[str, Any] = {"lw": 2.2, "alpha": 0.7}


#: Line styles of the even parts over opposite directions.
_DOTS = (":", (0, (1, 3)))


def draw_rigid(panel: kit.Panel, dilatancy: xr.Dataset, plateaus: xr.Dataset) -> list[Artist]:
    """Rigid dilatancy of every direction with the line fitted to its end; the legend."""
    for n, direction in enumerate(dilatancy["direction"].values):
        plateau, style = plateaus.sel(direction=direction), direction_style(n)
        label = f"{kit.TOWARDS[direction]}: {_change_words(plateau)}"
        one = dilatancy[["rigid_dilatancy"]].sel(direction=direction)
        panel.curve(one, "rigid_offset", "rigid_dilatancy", label=label, **style)
        ends = np.array([float(plateau[f"plateau_offset_{end}"]) for end in ("min", "max")])
        line = float(plateau["plateau_intercept"]) + float(plateau["plateau_slope"]) * ends
        panel.axes.plot(ends, line, color=style["color"], **_FITTED)
    parts = _draw_parts(panel, plateaus)
    lowest = float(dilatancy["rigid_dilatancy"].min())
    panel.axes.set(xlabel="offset $v$ (mm)", ylabel=r"rigid dilatancy $\delta_r$ (mm)")
    panel.axes.set_ylim(bottom=min(0, lowest))
    panel.axes.set_xlim(left=0)
    half = compact(float(dilatancy["rigid_offset"][-1]) / 2)
    change = rf"change of fitted $\delta_r$ [95 %] in % of its mean, $v \geq$ {half} mm"
    level = f"fitted lines; level: change within {percent(LEVEL_CHANGE)}"
    fitted = kit.mark(color="0.4", label=level, **_FITTED)
    return [kit.heading(change), *panel.entries, fitted, *parts]


def _draw_parts(panel: kit.Panel, plateaus: xr.Dataset) -> list[Artist]:
    """Even part over opposite directions, of each axis; entries that state the odd one."""
    drawn: list[Artist] = []
    for axis, dots in zip(plateaus["axis"].values, _DOTS, strict=False):
        one = plateaus[["even_dilatancy", "odd_dilatancy"]].sel(axis=axis)
        panel.keep(one, "even_dilatancy", "odd_dilatancy")
        style: dict[str, Any] = {"color": "0.35", "lw": 1.1, "ls": dots}
        panel.axes.plot(one["rigid_offset"], one["even_dilatancy"], **style, zorder=1)
        of_axis = plateaus.sel(axis=axis)
        change, tilt = float(of_axis["even_change"]), float(of_axis["odd_slope"])
        label = (
            f"mean of {axis}: {number(100 * change, 0, '+')} %; half the difference "
            f"{number(tilt, 3, '+')} $v$"
        )
        drawn.append(kit.mark(**style, label=label))
    return drawn


def direction_style(n: int) -> dict[str, Any]:
    """Line of the n-th direction, in both panels."""
    return {"color": kit.colour_of(n), "ls": kit.LINES[n % 4], "lw": 0.9}


def _change_words(plateau):
    """Change of the fitted line in per cent of the mean, and its name."""
    change = Estimate.read(plateau, "plateau_change").mapped(lambda fraction: 100 * fraction)
    if not change.known:
        return "no fit"
    value, low, high = change.ends
    return (
        f"{number(value, 0, '+')} % [{number(low, 0, '+')}, {number(high, 0, '+')}], "
        f"{plateau['plateau_trend'].item()}"
    )
