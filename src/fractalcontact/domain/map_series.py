"""Series of measured contact maps: their order, and the trend of the dimension with pressure."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.estimate import rows_of
from ..core.labels import natural_key
from .pressure_trend import pressure_trend

#: Variables of a map's series. A map alone is a series of one.
_TABLE = {
    "series_number": ("1", "place of the series, or of the map alone, among them"),
    "number_in_series": ("1", "place of the map in its series, by pressure"),
    **rows_of("pressure_slope", "1", "Delta_sigma over the series, per decade of pressure"),
    **rows_of(
        "pressure_slope_beyond_random",
        "1",
        "Delta_sigma less that of random cells over the series, per decade of pressure",
    ),
    "pressure_trend": ("1", "how Delta_sigma goes with pressure over the series"),
    "pressure_trend_beyond_random": ("1", "whether it goes otherwise than that of random cells"),
}


def with_series(maps: Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """Measured maps by name with their places in their series and its trend: :data:`_TABLE`.

    Maps are as :func:`domain.measured_map.read_contact_map` gives them.
    """
    placed = {}
    for number, names in enumerate(series_of_maps(maps)):
        pressure, value, random = (
            [float(maps[name][key]) for name in names]
            for key in ("nominal_pressure", "delta_sigma", "delta_sigma_random")
        )
        trend = pressure_trend(pressure, value, random)
        of_series = {
            "series_number": number,
            **trend.line.slope.columns("pressure_slope"),
            **trend.departure.slope.columns("pressure_slope_beyond_random"),
            "pressure_trend": trend.verdict,
            "pressure_trend_beyond_random": trend.beyond_random,
        }
        for place, name in enumerate(names):
            table = {key: ((), *words) for key, words in _TABLE.items()}
            values = of_series | {"number_in_series": place}
            placed[name] = maps[name].assign(labelled(table, values))
    return placed


def series_of_maps(maps: Mapping[str, xr.Dataset]) -> list[tuple[str, ...]]:
    """Names of the maps of each series, then of the maps alone.

    Maps of a series are in the order of their pressure, maps of unknown pressure last; maps without
    pressures and series are in the order of their names, numbers as numbers.
    """
    members: dict[str, list[str]] = {}
    for name in sorted(maps, key=natural_key):
        if maps[name].attrs["series"]:
            members.setdefault(maps[name].attrs["series"], []).append(name)
    series = [
        tuple(sorted(members[label], key=lambda name: _pressure(maps[name])))
        for label in sorted(members, key=natural_key)
    ]
    alone = sorted((name for name in maps if not maps[name].attrs["series"]), key=natural_key)
    return series + [(name,) for name in alone]


def _pressure(contact_map):
    """Nominal pressure, MPa; infinite where no load is stated."""
    pressure = float(contact_map["nominal_pressure"])
    return pressure if np.isfinite(pressure) else np.inf
