"""Measured contact maps of an atlas: their order, and the table of their numbers."""

from collections.abc import Mapping

import pandas as pd
import xarray as xr

from .estimate import names_of

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


def measured_maps(atlas: xr.DataTree) -> dict[str, xr.Dataset]:
    """Measured maps by name: series first, then single maps, each series in its own order."""
    if "contact_maps" not in atlas.children:
        return {}
    maps = {name: node.to_dataset() for name, node in atlas["contact_maps"].children.items()}
    places = {
        name: (int(contact["series_number"]), int(contact["number_in_series"]))
        for name, contact in maps.items()
    }
    return {name: maps[name] for name in sorted(maps, key=lambda name: places[name])}


def map_table(maps: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Table of measured maps by name, one row each: load, area and dimension, with the nulls."""
    rows = [
        {
            "map": name,
            "series": contact.attrs["series"],
            "label": contact.attrs["label"],
            "threshold": contact.attrs["threshold"],
            **{column: contact[variable].item() for column, variable in _COLUMNS.items()},
        }
        for name, contact in maps.items()
    ]
    return pd.DataFrame(rows)
