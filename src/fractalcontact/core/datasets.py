"""Labelled datasets made from a table: of each variable its dimensions, unit and long name."""

from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr

from .labels import cf_attrs

#: A name, several of them, or () for a number.
Dims = Sequence[str]


def labelled(
    table: Mapping[str, tuple[Dims, str, str]], values: Mapping[str, Any]
) -> dict[str, tuple[Dims, Any, dict[str, str]]]:
    """Variables with their dimensions and attributes, as ``xr.Dataset`` takes them.

    Parameters
    ----------
    table : mapping of str to (dims, str, str)
        Dimensions (a name, a tuple of names, or () for a number), unit and long name by variable.
    values : mapping of str to array_like
        Of the same names.

    Returns
    -------
    dict of str to (dims, array_like, dict)
        In the order of the table.

    Raises
    ------
    KeyError
        If a name of either is missing in the other.
    """
    if odd := table.keys() ^ values.keys():
        raise KeyError(f"not both in the table and among the values: {', '.join(sorted(odd))}")
    return {
        name: (dims, values[name], cf_attrs(units, long_name))
        for name, (dims, units, long_name) in table.items()
    }


def labelled_dataset(
    table: Mapping[str, tuple[Dims, str, str]],
    values: Mapping[str, Any],
    coords: Mapping[Any, Any] | None = None,
    attrs: Mapping[Any, Any] | None = None,
) -> xr.Dataset:
    """A dataset made from a table.

    Parameters
    ----------
    table, values
        As :func:`labelled` takes them.
    coords : mapping, optional
        As ``xr.Dataset`` takes them.
    attrs : mapping, optional
    """
    return xr.Dataset(labelled(table, values), coords=coords, attrs=attrs)


def domains_by_resolution(fields: xr.Dataset) -> dict[int, xr.DataArray]:
    """Contact domains ``in_contact_k`` of a dataset by their resolution k, the finest first."""
    start = "in_contact_"
    names = (str(name) for name in fields.data_vars if str(name).startswith(start))
    factors = sorted(int(name.removeprefix(start)) for name in names)
    return {k: fields[f"{start}{k}"] for k in factors}
