"""Quantities of all load curves from a function of one curve."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from .estimate import Estimate
from .labels import cf_attrs

#: Variables by name, as ``xr.Dataset`` takes them.
Variables = dict[str, tuple[Any, Any, dict[str, str]]]


def per_curve(
    curves: Mapping[Any, xr.DataArray],
    function: Callable[..., Mapping[str, Any]],
    names: Mapping[str, Sequence[str]],
    along: str | Sequence[str] = "normal_force",
) -> Variables:
    """Quantities of every load curve, by a function that sees one curve alone.

    Parameters
    ----------
    curves : mapping of str to DataArray
        Over ``along``, over other dimensions, or both; a dataset will do. The other dimensions, in
        the order in which they first occur, count the curves.
    function : callable
        Takes what ``curves`` holds of one curve by name, arrays over ``along`` or single values.
        Returns numbers, words, arrays and estimates, as :func:`stacked` takes them.
    names : mapping of str to (units, long_name, *dimensions)
        As of :func:`stacked`.
    along : str or sequence of str, optional
        Dimensions of one curve.

    Raises
    ------
    ValueError
        If coordinates of the curves differ.
    KeyError
        As of :func:`stacked`.
    """
    along = (along,) if isinstance(along, str) else tuple(along)
    aligned = xr.align(*curves.values(), join="exact", exclude=along)
    arrays = xr.broadcast(*aligned, exclude=along)
    dims = tuple(dict.fromkeys(dim for array in arrays for dim in array.dims if dim not in along))
    values = {
        name: array.transpose(*dims, *(dim for dim in along if dim in array.dims)).values
        for name, array in zip(curves, arrays, strict=True)
    }
    shape = tuple(arrays[0].sizes[dim] for dim in dims)
    results = [
        function(**{name: of_all[place] for name, of_all in values.items()})
        for place in np.ndindex(shape)
    ]
    return stacked(results, names, dims, shape)


def stacked(
    results: Iterable[Mapping[str, Any]],
    names: Mapping[str, Sequence[str]],
    dims: Sequence[Any],
    shape: Sequence[int] = (-1,),
) -> Variables:
    """Results of one curve each as variables over all curves.

    Parameters
    ----------
    results : iterable of mapping
        In C order over ``dims``: of each name a number, a word, an array or an `Estimate`, of one
        kind in all results. A result that lacks a name, or has a shorter array, is filled up with
        NaN, False or "".
    names : mapping of str to (units, long_name, *dimensions)
        Dimensions are those of an array, beside ``dims``.
    dims : sequence of str
    shape : sequence of int, optional
        Sizes of ``dims``.

    Raises
    ------
    KeyError
        If a name is in no result, or not among ``names``.
    """
    rows = list(results)
    if odd := set().union(*rows) ^ names.keys():
        raise KeyError(f"not both named and among the results: {', '.join(sorted(odd))}")
    variables: Variables = {}
    for name, (units, long_name, *own) in names.items():
        values, over = [row.get(name) for row in rows], (*dims, *own)
        if any(isinstance(value, Estimate) for value in values):
            ends = zip(*(value.ends if value else [None] * 3 for value in values), strict=True)
            value, low, high = (_filled(end, shape) for end in ends)
            variables |= Estimate(value, low, high).variables(name, over, units, long_name)
        else:
            variables[name] = over, _filled(values, shape), cf_attrs(units, long_name)
    return variables


def _filled(values: Sequence[Any], shape: Sequence[int]) -> np.ndarray:
    """Values, each as large as the largest of them, in an array of a shape; None is missing."""
    arrays = [np.asarray(value) for value in values if value is not None]
    largest = tuple(np.max([array.shape for array in arrays], axis=0).astype(int))
    if len(arrays) == len(values) and all(array.shape == largest for array in arrays):
        return np.reshape(arrays, (*shape, *largest))
    kind = np.result_type(*arrays)
    fill = {"b": False, "U": ""}.get(kind.kind, np.nan)
    table = np.full((len(values), *largest), fill, np.result_type(kind, type(fill)))
    for row, value in enumerate(values):
        if value is not None:
            place: tuple[Any, ...] = (row, *map(slice, np.shape(value)))
            table[place] = value
    return table.reshape(*shape, *largest)
