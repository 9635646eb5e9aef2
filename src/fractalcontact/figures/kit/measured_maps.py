"""Measured contact maps, one by one or in series, for the figures that draw them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from xarray import DataTree

from ...core.estimate import names_of
from ...core.measured_maps import map_table, measured_maps
from ...core.text import compact, number
from .drawing import COLOURS, MARKERS
from .points import reach

#: Maximum length of a label in a legend, letters.
_LONGEST = 34
#: Distance of a panel's title from its upper edge, points, above the axis of pressure.
_ABOVE = 30


@dataclass(frozen=True)
class Series:
    """Measured maps that belong together, or a single one.

    Names and maps are in the order of their pressure, those of unknown pressure last. The number is
    the place among all series, from which colour and marker follow.
    """

    label: str
    names: tuple[str, ...]
    maps: tuple[xr.Dataset, ...]
    number: int

    def values(self, name: str) -> np.ndarray:
        """One number of every map."""
        return np.array([one[name].item() for one in self.maps])

    @property
    def pressure(self) -> np.ndarray:
        """sigma_0 of every map, MPa; NaN where no load is stated."""
        return self.values("nominal_pressure").astype(float)

    @property
    def legend(self) -> str:
        """Label of a series for a legend, with the number of its maps."""
        label = self.label if len(self.label) <= _LONGEST else f"{self.label[: _LONGEST - 1]}…"
        return f"{label} ({len(self.maps)})" if len(self.maps) > 1 else label

    @property
    def style(self) -> dict:
        """Colour and marker of measured maps, distinct from those of computed domains."""
        n = self.number + 3
        return {"color": COLOURS[n % (len(COLOURS) - 1)], "marker": MARKERS[n % len(MARKERS)]}


def measured_series(atlas: DataTree) -> list[Series]:
    """Measured contact maps that were dropped in with the scans: series first, then single maps."""
    series: dict[int, dict[str, xr.Dataset]] = {}
    for name, one in measured_maps(atlas).items():
        series.setdefault(int(one["series_number"]), {})[name] = one
    return [
        Series(_label(maps), tuple(maps), tuple(maps.values()), number)
        for number, maps in series.items()
    ]


def _label(maps: Mapping[str, xr.Dataset]) -> str:
    """Label of a series, or of a map alone."""
    first, *_ = maps.values()
    return first.attrs["series"] or first.attrs["label"]


def draw_series(
    axes: Axes, series: Series, x: np.ndarray, label: str | None = None, *, nulls: bool = False
) -> None:
    """Delta_sigma of the maps of a series over x (n,), with intervals and the band of thresholds.

    NaN in x leaves a map out; `nulls` adds the dimension of random cells.
    """
    finite = np.isfinite(x)
    x = x[finite]
    value, low, high, least, most = (
        series.values(name)[finite]
        for name in (*names_of("delta_sigma"), "delta_sigma_least", "delta_sigma_most")
    )
    colour = series.style["color"]
    style = {"ls": "-" if len(x) > 1 else "none", "capsize": 2, "elinewidth": 0.8} | series.style
    axes.errorbar(x, value, yerr=reach(value, low, high), label=label, **style)
    if np.isfinite(least).any():
        if len(x) > 1:
            axes.fill_between(x, least, most, color=colour, alpha=0.15, lw=0)
        else:
            axes.vlines(x, least, most, color=colour, alpha=0.25, lw=5)
    if nulls:
        mean, low, high = (series.values(of)[finite] for of in names_of("delta_sigma_random"))
        style = {"color": colour, "lw": 0.8, "ls": ":", "marker": "none"}
        if len(x) > 1:
            axes.plot(x, mean, **style)
            axes.fill_between(
                x, low, high, facecolor="none", edgecolor=colour, hatch="....", lw=0, alpha=0.4
            )
        else:
            axes.errorbar(x, mean, yerr=reach(mean, low, high), **style)


def threshold_words(series: Sequence[Series]) -> str:
    """Smallest and largest threshold of the maps that are not binary, in words."""
    stated = [
        one["threshold"].values for each in series for one in each.maps if not one.attrs["binary"]
    ]
    if not stated:
        return "maps of 0 and 1"
    every = np.concatenate(stated)
    ends = dict.fromkeys(compact(end) for end in (every.min(), every.max()))
    return f"threshold{'s' if len(ends) > 1 else ''} {' to '.join(ends)}"


def table_of(series: Sequence[Series]) -> pd.DataFrame:
    """One row a map, series by series."""
    return map_table(
        {name: one for each in series for name, one in zip(each.names, each.maps, strict=True)}
    )


def draw_over_force(axes: Axes, series: Sequence[Series], nominal: float) -> None:
    """Measured domains over F (N), at their nominal pressure times A_0 of this window (mm2).

    The area of a measured map is another one, so that its own force has no place on this axis. A
    map without a pressure is a line across.
    """
    for each in series:
        pressure = each.pressure
        without = np.flatnonzero(~np.isfinite(pressure))
        label = f"measured: {each.legend}"
        if len(without) < len(pressure):
            draw_series(axes, each, pressure * nominal, label)
        for one in without:  # without a load it has no place along F
            value = float(each.maps[one]["delta_sigma"])
            name = f"{label}, no load" if one == without[0] else None
            axes.axhline(value, color=each.style["color"], ls="-.", lw=0.9, label=name)
    if series:
        axes.autoscale(axis="x")
    # The second axis has the pressure, by which maps of another area are placed.
    functions = (lambda force: force / nominal, lambda pressure: pressure * nominal)
    pressures = axes.secondary_xaxis("top", functions=functions)
    pressures.set_xlabel(r"nominal pressure $\sigma_0 = F/A_0$ (MPa)")
    axes.set_title(axes.get_title(loc="left"), loc="left", pad=_ABOVE)


def measured_range(series: Sequence[Series]) -> dict[str, Any]:
    """Number of measured maps, their thresholds and the range of their Delta_sigma."""
    values = np.array([value for each in series for value in each.values("delta_sigma")], float)
    finite = values[np.isfinite(values)]
    ends = [number(end) for end in (finite.min(), finite.max())] if finite.size else []
    words = threshold_words(series) if series else ""
    return {"maps": values.size, "measured": list(dict.fromkeys(ends)), "thresholds": words}
