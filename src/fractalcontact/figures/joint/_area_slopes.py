"""Area slope kappa over the reduced pressure: the right panel of the figure of area theories."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import LIGHT_LOAD
from ..kit.axes import label_short_span
from ..kit.drawing import COLOURS
from ..kit.empty import say_empty
from ..kit.kappa import kappa_lines
from ..kit.legends import heading, mark
from ..kit.points import reach
from ..kit.words import short

_GREY = "0.45"

#: Colour of a theory's kappa: that of its area.
_OF_KAPPA = {"bush": COLOURS[1], "persson": COLOURS[2]}
#: Of the means of kappa, corrected and raw: prefix of the name, words, face, place at the edge.
_MEANS = (("corrected_", "corrected", COLOURS[0], 0.05), ("", "raw", "white", 0.02))


def draw_kappa(axes: Axes, laws: xr.Dataset, law: xr.Dataset) -> None:
    """Loads of enough nodes: raw and corrected here, corrected at the other offsets."""
    others = laws.sel(offset=laws["offset"] != law["offset"])
    for i in range(others.sizes["offset"]):
        label = "corrected, other offsets" if i == 0 else None
        points = _touching(others.isel(offset=i), "corrected_")
        axes.plot(*points, color="0.75", lw=0.6, zorder=1, label=label)
    style: dict[str, Any] = {"color": COLOURS[0], "marker": "o", "lw": 0.7, "zorder": 3}
    axes.plot(*_touching(law, "corrected_"), **style)
    axes.plot(*_touching(law, ""), mfc="none", **style | {"lw": 0})
    for prefix, _, face, at in _MEANS:
        if not str(law[f"no_{prefix}mean_kappa"].values):
            mean = Estimate.read(law, f"{prefix}mean_kappa")
            bar: dict[str, Any] = {
                "fmt": "s",
                "color": COLOURS[0],
                "mfc": face,
                "capsize": 2,
                "elinewidth": 0.8,
            }
            edge = axes.get_yaxis_transform()
            axes.errorbar([at], [mean.value], yerr=reach(*mean.ends), transform=edge, **bar)
    if laws["fitted"].any():
        kappa_lines(axes, laws, _OF_KAPPA)
        label_short_span(axes.xaxis)
    if laws["line_pressure"].max() > LIGHT_LOAD:
        axes.axvline(LIGHT_LOAD, color=_GREY, lw=0.6, label="end of light load")
    if not law["fitted"].any():
        why = str(law["no_mean_kappa"].values)
        say_empty(axes, why or "no load with enough nodes in contact")
    axes.set_ylim(bottom=0)
    axes.set_xlabel(r"reduced pressure $\sigma_0/(E^* h'_\mathrm{rms})$ (1)")
    axes.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h'_\mathrm{rms}/\sigma_0$ (1)")


def _touching(law, prefix):
    """Reduced pressure and one kappa at the loads whose contact has enough nodes."""
    fitted = law[f"{prefix}fitted"].values
    return law["reduced_pressure"].values[fitted], law[f"{prefix}kappa"].values[fitted]


def kappa_entries(law: xr.Dataset) -> list[Line2D]:
    """Entries of the legend that state the mean kappas."""
    words = [
        mark(ls="none", marker="s", color=COLOURS[0], mfc=face, label=label)
        for prefix, words, face, _ in _MEANS
        if (label := f"mean at light load, {words}: {mean_kappa(law, prefix)}")
        and not str(law[f"no_{prefix}mean_kappa"].values)
    ]
    return words or [heading("no mean at light load")]


def mean_kappa(law: xr.Dataset, prefix: str) -> str:
    """Mean kappa at light load with its interval, if it has one."""
    mean = Estimate.read(law, f"{prefix}mean_kappa", scale=EXPONENT)
    return mean.text() if np.isfinite(mean.low) else f"{short(mean.value)} (one load)"
