"""Atlas of a study, in one file or in parts, read specimen by specimen."""

import json
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from ..core.errors import InputError
from ..core.subject import Subject, configuration_of, specimens_of
from .atlas import read_named_atlas


def open_atlas(path: Path | str) -> "Atlas":
    """Open the atlas of a study without reading its specimens.

    Parameters
    ----------
    path : path-like
        Folder of a study's results, or the ``atlas.nc`` in it, in one file or in parts.

    Raises
    ------
    InputError
        If there is none, or the file is no atlas.
    """
    path = Path(path)
    file = path / "atlas.nc" if path.is_dir() else path
    if not file.is_file():
        raise InputError(
            f"{file}: no such file; expected the atlas of a study, or the folder of its results, "
            "such as results/paper"
        )
    return Atlas(file)


class Atlas:
    """Atlas whose stages are read one by one, at their first use.

    ``atlas["closure/NAME"]`` is a dataset in memory, and ``atlas.stage("closure")`` goes from
    specimen to specimen without keeping any: a thousand specimens take the memory of one. No file
    stays open.

    Attributes
    ----------
    path : Path
    attrs : dict
        ``study``, ``configuration``, ``versions``, ``scan_checksums``: as of the file.
    specimens : tuple of str
    stages : tuple of str
        Stages of specimens and of the study.
    groups : dict of str to str
        Group of each specimen, as the study states it; empty where it states none.
    """

    def __init__(self, path: Path):
        self.path = path
        self.attrs, self._own = _contents(path)
        if "configuration" not in self.attrs:
            raise InputError(f"{path}: no atlas; it lacks the attribute 'configuration'")
        self._parts: dict[str, str] = _mapping(self.attrs, "parts", path)
        own = self._own.get("specimens", ())
        self.specimens: tuple[str, ...] = tuple(sorted({*own, *self._parts}))
        settings = _mapping(self.attrs, "configuration", path).get("settings", {})
        self.groups = {name: settings.get(name, {}).get("group", "") for name in self.specimens}

    def __repr__(self) -> str:
        where = f"in {len(self._parts)} parts" if self._parts else "in one file"
        study, n = self.attrs["study"], len(self.specimens)
        return f"<Atlas of the study {study}: {n} specimens, {where}>"

    @property
    def stages(self) -> tuple[str, ...]:
        """Stages of the study and those of its first specimen, in the order of an atlas."""
        first = _contents(self._file(self.specimens[0]))[1] if self._parts else {}
        return tuple(dict.fromkeys([*first, *self._own]))

    def __getitem__(self, key: str) -> xr.Dataset:
        """Dataset of a stage and a specimen, "STAGE/SPECIMEN", in memory.

        Raises
        ------
        KeyError
            If the atlas has none of these names.
        """
        stage, _, name = key.strip("/").partition("/")
        if name in self._own.get(stage, ()):
            return read_group(self.path, f"{stage}/{name}")[0]
        if name not in self._parts:
            raise KeyError(f"{key}: the atlas {self.path} has no such stage and specimen")
        return read_group(self._file(name), f"{stage}/{name}")[0]

    def stage(self, stage: str, group: str | None = None) -> Iterator[tuple[str, xr.Dataset]]:
        """Name and dataset of each specimen that has a stage; of one group alone if it is named."""
        for name in self.specimens:
            if group is None or self.groups[name] == group:
                try:
                    dataset = self[f"{stage}/{name}"]
                except KeyError:
                    continue
                yield name, dataset

    def specimen(self, name: str) -> xr.DataTree:
        """All stages of a specimen, opened by xarray: their arrays are read when they are used.

        Raises
        ------
        KeyError
            If there is no such specimen.
        """
        if name not in self.specimens:
            raise KeyError(f"{name}: no specimen of the atlas {self.path}")
        tree = xr.open_datatree(self._file(name), engine="netcdf4")
        own = {
            stage: group[name].to_dataset()
            for stage, group in tree.children.items()
            if name in group.children
        }
        return xr.DataTree.from_dict({"/": tree.to_dataset(), **own})

    def _file(self, name):
        return self.path.parent / self._parts[name] if name in self._parts else self.path


class Trees:
    """Atlas as trees in memory: one of all specimens, or one a specimen, read when asked for.

    Only the stages named are read.

    Attributes
    ----------
    root : xr.DataTree
        All of the study, or what its specimens have together.
    names : list of str
        Specimens.
    parts : dict of str to str
        Files of the specimens, below the folder of the atlas; empty where it is one file.
    held : frozenset of str
        Names of the groups of the file, those left out too.
    """

    def __init__(self, path: Path | str, stages: Collection[str]):
        self.path, self._stages = Path(path), frozenset(stages)
        self.root, self.held = read_named_atlas(path, only=self._stages)
        self.parts: dict[str, str] = _mapping(self.root.attrs, "parts", self.path)
        self.names = sorted({*specimens_of(self.root), *self.parts})

    def of(
        self, name: str, without: Collection[str] = ()
    ) -> tuple[xr.DataTree, frozenset[str], Path]:
        """Tree with the stages of a specimen, names of the groups of its file, and the file.

        ``without`` names stages of an atlas in parts that are not read.
        """
        if name not in self.parts:
            return self.root, self.held, self.path
        file = self._file(name)
        return *read_named_atlas(file, without, self._stages), file

    def closure(self, name: str) -> Subject:
        """Closure curves of a specimen alone, which determine what is reported."""
        if name in self.parts:
            curves = read_group(self._file(name), f"closure/{name}")[0]
        else:
            curves = self.root[f"closure/{name}"].to_dataset()
        return Subject({"closure": curves}, configuration_of(self.root)["settings"][name], name)

    def _file(self, name):
        return self.path.parent / self.parts[name]


def read_group(path: Path | str, group: str) -> tuple[xr.Dataset, Mapping[str, Any]]:
    """One group "STAGE/SPECIMEN" of a netCDF-4 file in memory, and the attributes of the file.

    Raises
    ------
    KeyError
        If the file has no such group.
    InputError
        If it cannot be read.
    """
    with _opened(path) as file:
        try:
            members = file[group]
        except (IndexError, KeyError):
            raise KeyError(f"{path}: no group {group}") from None
        dataset = xr.open_dataset(xr.backends.NetCDF4DataStore(members)).load()
        return dataset, {name: file.getncattr(name) for name in file.ncattrs()}


def _mapping(attrs: Mapping[Any, Any], name: str, path: Path) -> dict[str, Any]:
    """Mapping that an attribute of an atlas holds as JSON; empty where there is none."""
    try:
        held = json.loads(attrs.get(name, "{}"))
    except (TypeError, ValueError) as error:
        raise InputError(f"{path}: no atlas; its attribute '{name}' is no JSON ({error})") from None
    if not isinstance(held, dict):
        raise InputError(f"{path}: no atlas; its attribute '{name}' holds no mapping")
    return held


def _contents(path):
    """Attributes of a file, and the names of its groups by stage."""
    with _opened(path) as file:
        attrs = {name: file.getncattr(name) for name in file.ncattrs()}
        return attrs, {name: tuple(stage.groups) for name, stage in file.groups.items()}


def _opened(path):
    import netCDF4

    try:
        return netCDF4.Dataset(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read as netCDF-4 ({error})") from error
