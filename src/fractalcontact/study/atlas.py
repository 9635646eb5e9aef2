"""Atlas of a study: all its results in one netCDF-4 file, a group for each stage and specimen."""

import json
from collections.abc import Collection, Hashable, Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from ..core.atomic import atomic_write
from ..core.netcdf import COMPRESSED_FROM, encoding, versions

#: Significant digits of the maps of pressure and gap, which the atlas has in single precision.
FIELD_DIGITS = 3
#: Variables of heights that are stored in equal steps, and the steps to either side of the middle.
#: Composites follow from the faces and get what 16 bits hold; faces get 16 times as many steps, of
#: some nanometres each.
HEIGHTS = {"composite": 2**15 - 2, "lower": 2**19 - 2, "upper": 2**19 - 2}


def write_atlas(
    parts: Mapping[str, Mapping[str, xr.Dataset]],
    path: Path | str,
    *,
    study: str,
    configuration: Mapping,
    made_with: Mapping[str, Mapping[str, dict]] | None = None,
    parts_in: Mapping[str, str] | None = None,
    checksums: Mapping[str, Mapping[str, str]] | None = None,
    differing: Mapping[str, list[str]] | None = None,
) -> dict[str, list[str]]:
    """Write all results of a study into one file.

    Parameters
    ----------
    parts : mapping of str to mapping of str to xr.Dataset
        Stage to specimen to dataset. Its attribute ``title`` describes the stage.
    path : path-like
    study : str
        Name of the study.
    configuration : mapping
        The study's configuration, kept word for word as JSON.
    made_with : mapping of str to mapping of str to dict, optional
        Stage to specimen to the versions each part was made with, from
        :func:`core.netcdf.read_with_versions`; those in use by default.
    parts_in : mapping of str to str, optional
        Files with the stages of each specimen, below the folder of this one, if they are not in it.
    checksums : mapping of str to mapping of str to str, optional
        SHA-256 of the scans in ``parts_in``, by specimen and face.
    differing : mapping of str to list of str, optional
        Parts in ``parts_in`` by versions that differ from those in use.

    Returns
    -------
    dict of str to list of str
        Parts by the versions they were made with, where those differ; else empty. The attribute
        ``versions`` then holds those in use, ``versions_differ`` this.

    Raises
    ------
    ValueError
        If a variable has no unit or no long name: nothing unlabelled enters the atlas.
    """
    differing = {**(differing or {}), **_by_versions(made_with or {})}
    root = xr.Dataset(
        attrs={
            "title": f"fractalcontact study {study}",
            "study": study,
            "configuration": json.dumps(configuration, sort_keys=True),
            "versions": json.dumps(versions()),
            "scan_checksums": json.dumps(
                {**_checksums(parts.get("specimens", {})), **(checksums or {})}, sort_keys=True
            ),
        }
    )
    if parts_in:
        root.attrs["parts"] = json.dumps(dict(parts_in), sort_keys=True)
    if differing:
        root.attrs["versions_differ"] = json.dumps(differing, sort_keys=True)
    groups = {"/": root}
    for stage, specimens in parts.items():
        groups[f"/{stage}"] = xr.Dataset()
        for name, dataset in specimens.items():
            _demand_labels(dataset, f"{stage}/{name}")
            own = groups[f"/{stage}/{name}"] = dataset.copy(deep=False)
            if title := own.attrs.pop("title", ""):  # that of its stage, once for all specimens
                groups[f"/{stage}"].attrs["description"] = title
    with atomic_write(path) as temporary:
        _write_groups(groups, temporary)
    return differing


def _by_versions(made_with):
    """Names of parts by their versions; empty if all are those in use."""
    parts: dict[str, list[str]] = {}
    for stage, specimens in made_with.items():
        for name, used in specimens.items():
            parts.setdefault(words_of(used) or "unknown versions", []).append(f"{stage}/{name}")
    return {} if set(parts) <= {words_of(versions())} else parts


def words_of(used: Mapping[str, str]) -> str:
    """Names and versions of libraries in one line."""
    return ", ".join(f"{library} {version}" for library, version in sorted(used.items()))


class _DeferredWriter:
    """Buffer of variables, written once every variable of a file is declared.

    Each change from declaring to writing makes the netCDF library go through the whole file: with
    two thousand variables that took nine tenths of the time.
    """

    def __init__(self):
        self.pending = []

    def add(self, source, target, region=None):
        """Keep a variable; xarray calls this."""
        self.pending.append((source, target))

    def write(self):
        """Write the variables that `add` kept."""
        for source, target in self.pending:
            target[...] = source


def _write_groups(groups, path):
    """Write datasets into the groups of one file, which is opened once.

    ``DataTree.to_netcdf`` opens it again for every group and goes through all that are there.
    """
    import netCDF4

    with netCDF4.Dataset(path, "w") as file:
        writer = _DeferredWriter()
        for name, dataset in groups.items():
            group = file if name == "/" else file.createGroup(name)
            backend = xr.backends.NetCDF4DataStore(group)
            stored_as = encoding(dataset, FIELD_DIGITS) | _as_characters(dataset)
            stored_as |= _in_steps(dataset)
            dataset.dump_to_store(backend, encoding=stored_as, writer=writer)
        writer.write()


def _in_steps(dataset: xr.Dataset) -> dict[Hashable, dict]:
    """Encoding of heights: equal steps of :data:`HEIGHTS` between the lowest and the highest.

    Most of the 64 bits of a height are noise that no compression removes.
    """
    kept: dict[Hashable, dict] = {}
    for name in HEIGHTS.keys() & dataset.variables.keys():
        values = dataset[name].values
        heights = values[np.isfinite(values)]
        if values.nbytes < COMPRESSED_FROM or not heights.size or heights.min() == heights.max():
            continue
        low, high, most = float(heights.min()), float(heights.max()), HEIGHTS[name]
        kept[name] = {
            "dtype": "int16" if most < 2**15 else "int32",
            "scale_factor": (high - low) / (2 * most),
            "add_offset": (high + low) / 2,
            "_FillValue": -most - 1,
            "zlib": True,
            "complevel": 4,
            "shuffle": True,
        }
    return kept


def _as_characters(dataset: xr.Dataset) -> dict[Hashable, dict]:
    """Encoding of words: arrays of characters, which every reader can open repeatedly.

    Strings of variable length, netCDF's usual form, end a process with a segmentation fault that
    opens the file, or any group of it, while it holds the file open already, closes one of the
    two and opens it once more: HDF5 keeps the type of such strings once for a file, with a pointer
    to the handle that was open first (netcdf4-python issues 261 and 1444, xarray issue 9093).
    A notebook does that easily, with ``open_datatree`` in a cell that runs twice.
    """
    kept: dict[Hashable, dict] = {}
    for name, variable in dataset.variables.items():
        if variable.dtype.kind not in "UO":
            continue
        kept[name] = {"dtype": "S1"}
        if variable.size * 8 >= COMPRESSED_FROM:
            kept[name] |= {"zlib": True, "complevel": 4}
    return kept


def read_atlas(
    path: Path | str, without: Collection[str] = (), only: Collection[str] | None = None
) -> xr.DataTree:
    """Atlas as an xarray DataTree, in memory.

    Parameters
    ----------
    path : path-like
    without : collection of str
        Stages to leave out.
    only : collection of str, optional
        Stages to read; all by default.

    Notes
    -----
    The file is opened once, read group by group and closed. Opening every group by itself takes a
    quarter of a second each, because all the others are gone through. Handles that the process has
    opened before make no difference.
    """
    return read_named_atlas(path, without, only)[0]


def read_named_atlas(
    path: Path | str, without: Collection[str] = (), only: Collection[str] | None = None
) -> tuple[xr.DataTree, frozenset[str]]:
    """Atlas as by :func:`read_atlas`, and names of all groups that hold anything, left out or not.

    A name is "STAGE" or "STAGE/SPECIMEN".
    """
    import netCDF4

    with netCDF4.Dataset(path) as file:
        held: set[str] = set()
        groups = {"/": file}
        for name, stage in file.groups.items():
            members = {group.path: group for group in (stage, *stage.groups.values())}
            held |= {
                key.strip("/") for key, group in members.items() if group.variables or group.groups
            }
            if name not in without and (only is None or name in only):
                groups |= members
        loaded = {
            name: xr.open_dataset(xr.backends.NetCDF4DataStore(group)).load()
            for name, group in groups.items()
        }
    return xr.DataTree.from_dict(loaded), frozenset(held)


def _checksums(specimens):
    """SHA-256 of every scan file, by specimen and face."""
    return {
        name: {
            face: json.loads(dataset.attrs[f"{face}_scan"])["sha256"]
            for face in ("lower", "upper")
            if f"{face}_scan" in dataset.attrs
        }
        for name, dataset in specimens.items()
    }


def _demand_labels(dataset, where):
    for name in dataset.variables:
        # Users could not reach the variable as an attribute of the dataset.
        if hasattr(xr.Dataset, str(name)):
            raise ValueError(f"{where}: variable {name} has the name of a method of xarray.Dataset")
    for name, variable in dataset.data_vars.items():
        missing = [key for key in ("units", "long_name") if key not in variable.attrs]
        if missing:
            raise ValueError(f"{where}: variable {name} has no {' and no '.join(missing)}")
