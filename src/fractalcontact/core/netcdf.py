"""Datasets as netCDF-4 files, written atomically, with the versions of their libraries.

Nothing that differs between two runs of one study (times, host names, paths) is written, so that
the same configuration, scans, versions and machine give the same bytes.
"""

import json
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import xarray as xr

from .atomic import atomic_write

#: Libraries whose version can change a number.
_NUMBER_MAKERS = ("fractalcontact", "numpy", "scipy", "numba", "xarray")


#: Least size in bytes of an array whose compression gains more than its chunks cost.
COMPRESSED_FROM = 4096

#: Attribute of every part with the versions of the libraries that made it.
_VERSIONS = "made_with"


def write(dataset: xr.Dataset, path: Path | str) -> None:
    """Write a dataset as netCDF-4, compressed, whole or not at all, with the versions in use."""
    marked = dataset.assign_attrs({_VERSIONS: json.dumps(versions())})
    with atomic_write(path) as temporary:
        marked.to_netcdf(temporary, engine="netcdf4", encoding=encoding(dataset))


def read(path: Path | str) -> xr.Dataset:
    """A dataset written by :func:`write`, in memory.

    Its encoding is dropped: the length of its longest word would cut off those of other datasets in
    a concatenation. Integers with an attribute ``_FillValue`` stay integers.
    """
    return read_with_versions(path)[0]


def read_with_versions(path: Path | str) -> tuple[xr.Dataset, dict[str, str]]:
    """A dataset written by :func:`write`, and the versions it was made with by library."""
    # Small integers keep the number that marks missing ones: floats with NaN would take four times
    # the memory.
    with xr.open_dataset(path, engine="netcdf4", mask_and_scale=False) as dataset:
        dataset = dataset.load().drop_encoding()
    for variable in dataset.variables.values():
        if variable.dtype.kind == "f":
            variable.attrs.pop("_FillValue", None)
    return dataset, json.loads(dataset.attrs.pop(_VERSIONS, "{}"))


@cache
def versions() -> dict[str, str]:
    """Versions of the libraries in use that can change a number, by name."""
    return {name: metadata.version(name) for name in _NUMBER_MAKERS}


def encoding(dataset: xr.Dataset, digits: int | None = None) -> dict[Any, dict[str, Any]]:
    """Encoding of the variables of a dataset: large arrays compressed, small ones plain.

    Compressed arrays are stored in chunks, whose index takes some 2 kB a variable: more than most
    variables of an atlas. ``digits`` are the significant decimal digits stored of floats in single
    precision, all by default. The netCDF library rounds the bits behind them (granular bit
    rounding) and states so in an attribute of the variable.
    """
    kept: dict[Any, dict[str, Any]] = {}
    for name, variable in dataset.variables.items():
        if variable.size == 0 or variable.ndim == 0 or variable.dtype.kind not in "fiub":
            continue
        if variable.nbytes < COMPRESSED_FROM:
            kept[name] = {"contiguous": True}
            continue
        kept[name] = {"zlib": True, "complevel": 4, "shuffle": True}
        if digits is not None and variable.dtype == "float32":
            kept[name] |= {"significant_digits": digits, "quantize_mode": "GranularBitRound"}
    return kept
