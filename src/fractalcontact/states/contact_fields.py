"""Contact fields of the atlas: contact domains with coordinates, pressure and gap of the maps."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.datasets import domains_by_resolution
from ..core.labels import cf_attrs
from ..core.settings import ContactSettings
from .states import MAP_GAP, MAP_PRESSURE, forces_of

#: Value where a state was not solved; xarray reads it as missing.
NOT_SOLVED = -1


def contact_fields(
    domains: xr.Dataset,
    parts: Sequence[xr.Dataset],
    joint: xr.Dataset,
    settings: ContactSettings,
    area: float,
) -> xr.Dataset:
    """Stage contact: contact domains of all states, and fields at the offset of the maps.

    ``domains`` come from :func:`states.states.contact_domains`, ``parts`` from
    :func:`states.sweep.contact_states`, the coordinates from the window of ``joint``; A_0 in mm2.
    ``in_contact_k`` (direction, offset, normal_force, y_k, x_k) is 1 in contact, 0 not, missing
    where the state was not solved; ``map_pressure``, MPa, and, under the loads of the maps and of
    the dilatancy alone, ``map_gap``, mm, are float32 (normal_force, y_k, x_k). Attributes
    ``map_direction``, ``map_offset`` (mm), ``map_load`` (N) and ``map_resolution`` say where.

    Missing is -1 in the file and its ``_FillValue``, so that xarray, and whatever else knows
    netCDF's attributes, gives NaN; compare with 1 to select cells in contact.
    """
    result = domains.copy()
    for factor, domain in domains_by_resolution(domains).items():
        solved = domains["solved"].sel(resolution=factor)
        result[domain.name] = _with_missing(domain, solved)
        result = result.assign_coords(_coordinates(joint, factor))
    part = next((part for part in parts if MAP_PRESSURE in part), None)
    if part is None:
        return result
    forces = part["normal_force"].values
    loads = forces_of(settings.drawn_loads, area)
    kept = np.isin(forces, loads)
    pressure, gap = part[MAP_PRESSURE], part[MAP_GAP]
    values = {
        MAP_PRESSURE: pressure.values,
        MAP_GAP: np.where(kept[:, np.newaxis, np.newaxis], gap.values, np.float32(np.nan)),
    }
    for name, of_map in values.items():
        words = cf_attrs(part[name].attrs["units"], part[name].attrs["long_name"])
        result[name] = (pressure.dims, of_map, words)
    place = pressure.attrs
    return result.assign_attrs(
        map_direction=str(place["direction"]),
        map_offset=float(place["offset"]),
        map_load=float(forces_of([settings.map_load], area)[0]),
        map_resolution=int(place["resolution"]),
    )


def _with_missing(domain: xr.DataArray, solved: xr.DataArray) -> xr.DataArray:
    """Contact domains as small integers, with states that were not solved as missing."""
    order = ("direction", "offset", "normal_force")
    domain = domain.transpose(*order, ...)
    values = domain.values.astype(np.int8)
    values[~solved.transpose(*order).values] = NOT_SOLVED
    words = f"{domain.attrs['long_name']}: 1 in contact, 0 not"
    attrs = cf_attrs("1", words) | {"_FillValue": np.int8(NOT_SOLVED)}
    return xr.DataArray(values, dims=domain.dims, attrs=attrs)


def _coordinates(joint: xr.Dataset, factor: int) -> dict[str, tuple]:
    """Places of the nodes at a resolution, mm, in the coordinates of the scan: every k-th."""
    return {
        f"{axis}_{factor}": (
            f"{axis}_{factor}",
            joint[f"window_{axis}"].values[::factor],
            cf_attrs("mm", f"{axis} of the node, in the coordinates of the scan"),
        )
        for axis in "yx"
    }
