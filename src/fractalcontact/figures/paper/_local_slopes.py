"""Local slopes of box counts beside their null models: a panel of Fig. 9."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.colors import to_rgba

from ...core.estimate import Estimate
from .. import kit

#: Grey of random nodes, and style of the bearing-area cut.
RANDOM = "0.7"
CUT: dict[str, Any] = {"ls": "-.", "color": kit.COLOURS[4]}
#: Colours of the count law and of the ordinary slope.
LAW, ORDINARY = kit.COLOURS[2], kit.COLOURS[0]
_SIDES = ("local_slope_side", "local_slope_side_min", "local_slope_side_max")
_SLOPES = ("local_slope", "local_slope_random", "local_slope_cut")


def draw_slopes(panel: kit.Panel, counts: xr.Dataset) -> None:
    """Local slopes with intervals over the box side, beside those of the null models."""
    axes = panel.axes
    panel.keep(counts, *_SIDES, *_SLOPES)
    slopes = counts.isel(null_octave=counts["local_slope"].notnull().values)
    middle, slope = slopes["local_slope_side"].values, Estimate.read(slopes, "local_slope")
    random, low, high = Estimate.read(slopes, "local_slope_random").ends
    axes.fill_between(middle, low, high, color=RANDOM, lw=1.5, zorder=0)
    axes.plot(middle, random, color=RANDOM, lw=1)
    axes.plot(middle, slopes["local_slope_cut"], **CUT, lw=1)
    bars: dict[str, Any] = {"yerr": kit.reach(*slope.ends), "fmt": "D", "ms": 4, "lw": 0.8}
    axes.errorbar(middle, slope.value, color=LAW, **bars)
    axes.set_xscale("log")
    for name, fit, sure, colour, ls in (
        ("delta_sigma", "fit", "determined", LAW, "-"),
        ("delta_sigma_ordinary", "ordinary_fit", "ordinary_determined", ORDINARY, "--"),
    ):
        ends, level = [float(counts[f"{fit}_{end}"]) for end in ("min", "max")], counts[name]
        if np.isfinite(level):
            weak = {} if bool(counts[sure]) else kit.WEAK
            axes.plot(ends, [float(level)] * 2, color=colour, ls=ls, **weak)
            axes.fill_between(ends, *Estimate.read(counts, name).ends[1:], **band_of(colour))
    axes.set_ylim(-0.1, 2.3)
    axes.set(xlabel="box side $r$ (mm)", ylabel=r"local slope $-$d log $N$ / d log $r$ (1)")


def band_of(colour: str) -> dict[str, Any]:
    """Style of the interval of a fit in (c): that of the black one hides nothing grey."""
    if colour == ORDINARY:
        return {"fc": "none", "ec": colour, "ls": ":", "lw": 0.8}
    return {"fc": to_rgba(colour, 0.15), "ec": "none"}
