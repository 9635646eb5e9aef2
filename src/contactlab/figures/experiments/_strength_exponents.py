"""Exponents of the strength over the side: the lower panels of the size effect of the strength."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from fractalcontact.core.estimate import Estimate
from fractalcontact.figures.kit.drawing import MARKERS
from fractalcontact.figures.kit.legends import heading, mark
from fractalcontact.figures.kit.points import reach

#: Colour of exponents: those of the sides stand for sides alone.
_OF_EXPONENTS = "k"
#: Law of contact whose points are filled.
ELASTIC = "elastic"


def faces_of(law: str, colour: str) -> dict[str, Any]:
    """Filled where the contact is elastic, hollow where its pressure is capped."""
    return {"color": colour, "mfc": colour if law == ELASTIC else "white"}


def draw_exponents(axes: Axes, test: xr.Dataset) -> None:
    """Exponents with their intervals, those at equal v to the left, at equal v/b to the right."""
    intervals, fractions = test.sizes["interval"], test.sizes["fraction"]
    places = np.arange(1 + intervals + fractions)
    axes.axhspan(-test.attrs["bound"], test.attrs["bound"], color="0.9", lw=0, zorder=0)
    axes.axhline(0, color="0.6", lw=0.8, zorder=0)
    groups = _groups(test)
    for n, (law, load) in enumerate(groups):
        one = test.sel(law=law, reduced_pressure=load)
        x = places + 0.7 * ((n + 0.5) / len(groups) - 0.5)
        names = ("pooled_exponent", "strength_exponent", "scaled_strength_exponent")
        parts = [Estimate.read(one, name).ends for name in names]
        ends = [np.r_[tuple(np.atleast_1d(end) for end in of)] for of in zip(*parts, strict=True)]
        style = {**faces_of(law, _OF_EXPONENTS), "yerr": reach(*ends), "elinewidth": 0.7}
        axes.errorbar(x, ends[0], fmt=_marker(load, test), **style)
        scaled = x[1 + intervals :]
        axes.plot(scaled, one["predicted_exponent"], "_", color=_OF_EXPONENTS, ms=12, zorder=0)
        axes.plot(scaled, one["theory_exponent"], "x", color="0.6", ms=5, zorder=0)
    if fractions:
        axes.axvline(intervals + 0.5, color="0.6", lw=0.8)
    of_v = zip(test["interval_low"].values, test["interval_high"].values, strict=True)
    of_b = zip(test["fraction_low"].values, test["fraction_high"].values, strict=True)
    labels = [f"{low:g} to {high:g}" for low, high in of_v]
    labels += [f"1/{1 / low:.4g} to 1/{1 / high:.4g}" for low, high in of_b]
    axes.set_xticks(places, ["all together", *labels], fontsize=7)
    axes.tick_params(axis="x", rotation=90)


def _groups(test: xr.Dataset) -> list[tuple[str, float]]:
    return [(law, load) for load in test["reduced_pressure"].values for law in test["law"].values]


def _marker(load: float, test: xr.Dataset) -> str:
    return MARKERS[list(test["reduced_pressure"].values).index(load)]


def law_entries(test: xr.Dataset) -> list:
    entries: list = [heading("exponent: $p/(E^* h'_\\mathrm{rms})$")]
    for law, load in _groups(test):
        style = {**faces_of(law, _OF_EXPONENTS), "marker": _marker(load, test), "ls": "none"}
        entries.append(mark(label=f"{law}, {load:g}", **style))
    return entries
