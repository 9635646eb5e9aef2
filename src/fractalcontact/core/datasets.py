"""Labelled datasets from a table of their variables: name, dimensions, unit, long name."""

import functools
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ParamSpec, TypeVar

import xarray as xr

from .labels import cf_attrs

#: Dimensions: a name, several names, or () for a number.
Dims = Sequence[str]
Given = ParamSpec("Given")
Made = TypeVar("Made", xr.Dataset, dict[str, xr.Dataset])


def titled(
    title: str = "", **titles: str
) -> Callable[[Callable[Given, Made]], Callable[Given, Made]]:
    """Decorator of the function of a stage, which gives its dataset the attribute ``title``.

    It is the description of the stage's group in the atlas: ``title`` of a function that gives one
    dataset, ``titles`` by name of a function that gives several.
    """

    def decorate(function: Callable[Given, Made]) -> Callable[Given, Made]:
        @functools.wraps(function)
        def make(*args: Given.args, **kwargs: Given.kwargs) -> Made:
            result = function(*args, **kwargs)
            if isinstance(result, xr.Dataset):
                return result.assign_attrs(title=title)
            return {
                name: dataset.assign_attrs(title=titles[name]) for name, dataset in result.items()
            }

        return make

    return decorate


def labelled(
    table: Mapping[str, tuple[Dims, str, str]], values: Mapping[str, Any]
) -> dict[str, tuple[Dims, Any, dict[str, str]]]:
    """Variables with their dimensions and attributes, as ``xr.Dataset`` takes them.

    Parameters
    ----------
    table : mapping of str to (dims, str, str)
        Dimensions (a name, a tuple of names, or () for a number), unit and long name by variable.
    values : mapping of str to array_like
        Values by variable.

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
    """Dataset of :func:`labelled` variables; coordinates and attributes are those of xarray."""
    return xr.Dataset(labelled(table, values), coords=coords, attrs=attrs)


def domains_by_resolution(fields: xr.Dataset) -> dict[int, xr.DataArray]:
    """Contact domains ``in_contact_k`` of a dataset by their resolution k, the finest first."""
    start = "in_contact_"
    names = (str(name) for name in fields.data_vars if str(name).startswith(start))
    factors = sorted(int(name.removeprefix(start)) for name in names)
    return {k: fields[f"{start}{k}"] for k in factors}
