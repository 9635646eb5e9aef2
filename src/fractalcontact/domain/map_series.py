"""Series of measured contact maps: their order, and the table of their numbers."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from ..core.estimate import names_of
from ..core.labels import natural_key

#: Columns of the table, and the variables of a map that they hold.
_COLUMNS = {
    "load_N": "force",
    "nominal_pressure_MPa": "nominal_pressure",
    "nominal_area_mm2": "nominal_area",
    "area_mm2": "area",
    "area_share": "area_share",
    **{name: name for name in names_of("delta_sigma")},
    "least_over_thresholds": "delta_sigma_least",
    "most_over_thresholds": "delta_sigma_most",
    **dict(zip(names_of("random_cells"), names_of("delta_sigma_random"), strict=True)),
    "verdict": "null_verdict",
    "reason": "reason",
}


class MapSeries(NamedTuple):
    """Maps that belong together, or a single one.

    Attributes
    ----------
    label : str
        Of the series, or of its only map.
    names : tuple of str
        Of its maps, in the order of their pressure; those of unknown pressure last.
    """

    label: str
    names: tuple[str, ...]


def series_of_maps(maps: Mapping[str, xr.Dataset]) -> list[MapSeries]:
    """Series of maps, then single maps; what no pressure orders is by name, numbers as numbers.

    Parameters
    ----------
    maps : mapping of str to xr.Dataset
        As :func:`domain.measured_map.read_contact_map` gives them, by name.
    """
    members: dict[str, list[str]] = {}
    for name in sorted(maps, key=natural_key):
        if maps[name].attrs["series"]:
            members.setdefault(maps[name].attrs["series"], []).append(name)
    found = [
        MapSeries(label, tuple(sorted(names, key=lambda name: _pressure(maps[name]))))
        for label, names in sorted(members.items(), key=lambda one: natural_key(one[0]))
    ]
    alone = sorted((name for name in maps if not maps[name].attrs["series"]), key=natural_key)
    return found + [MapSeries(maps[name].attrs["label"], (name,)) for name in alone]


def _pressure(one):
    """Nominal pressure, MPa; infinite where no load is stated."""
    pressure = float(one["nominal_pressure"])
    return pressure if np.isfinite(pressure) else np.inf


def map_table(names: Sequence[str], maps: Sequence[xr.Dataset]) -> pd.DataFrame:
    """Table of measured maps, one row each: load, area and dimension, with the nulls.

    Parameters
    ----------
    names : sequence of str
    maps : sequence of xr.Dataset
    """
    rows = [
        {
            "map": name,
            "series": one.attrs["series"],
            "label": one.attrs["label"],
            "threshold": one.attrs["threshold"],
            **{column: one[variable].item() for column, variable in _COLUMNS.items()},
        }
        for name, one in zip(names, maps, strict=True)
    ]
    return pd.DataFrame(rows)
