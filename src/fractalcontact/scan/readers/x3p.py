"""Surfaces and clouds in X3P containers (ISO 25178-72), through x3pio."""

import hashlib
import io
import zipfile
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...gridding.ungridded import NOTE
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading
from ..tables import choose_array

_INDEX = "main.xml"
_CHANGED = (
    ": the file was changed, or was written with a wrong checksum; it was read nevertheless, so "
    "compare it with its source"
)
#: Root element of main.xml in ISO 5436-2 of 2000, which R's x3ptools still writes.
_OLD_ROOT, _ROOT = "ISO5436", "ISO5436_2"


def read_x3p(path: Path, options: ScanOptions) -> RawScan:
    """Layer of an X3P file; lengths are metres by the standard.

    A regular grid is a matrix; an irregular one and a point cloud are points, in the file's global
    coordinates. A file that does not match the checksums it states is read with a warning.
    """
    import x3pio

    with reading(path, "X3P file"):
        source, origin, notes = _open(path)
        try:
            file = x3pio.read(source)
        except x3pio.X3pChecksumError as error:
            # The checksums of the zip archive hold, else unpacking had failed.
            notes = (*notes, f"{NOTE}{error}{_CHANGED}")
            if not isinstance(source, str):
                source.seek(0)
            file = x3pio.read(source, verify=False)
        if isinstance(file, x3pio.Profile):
            raise InputError(f"{path}: holds a profile (FeatureType PRF); a surface is needed")
        names = [f"layer {number}" for number in range(1, len(file.layers) + 1)]
        name = choose_array(names, options.variable, path)
        layer = file.layers[names.index(name)]
    stated: dict[str, Any] = {
        "reader": f"x3pio {x3pio.__version__} / x3p",
        "unit_xy": "m",
        "unit_z": "m",
        "notes": (*notes, *([f"{name} of {len(names)}"] if len(names) > 1 else [])),
    }
    if isinstance(file, x3pio.PointCloud) or not layer.is_regular_grid:
        return RawScan(layer.points().reshape(-1, 3), "points", **stated)
    return _regular(layer, origin, stated)


def _open(path: Path):
    """Input of x3pio, place of the first row ("NW", ...; "" if not stated), and notes.

    x3pio knows no files of the standard's first edition. The root element of such a file is renamed
    in memory.
    """
    from defusedxml import ElementTree

    with zipfile.ZipFile(path) as archive:
        indices = [
            name
            for name in archive.namelist()
            if PurePosixPath(name).name == _INDEX and not name.startswith("__MACOSX")
        ]
        if len(indices) != 1:
            raise InputError(f"{path}: an X3P file has one {_INDEX}, this one has {len(indices)}")
        index = archive.read(indices[0])
        root = ElementTree.fromstring(index)
        origin = (root.findtext("Record1/Axes/Origin") or "").strip()
        if root.tag != _OLD_ROOT:
            return str(path), origin, ()
        notes = _verify_index(archive, PurePosixPath(indices[0]).parent, index, root)
        root.tag = _ROOT
        repacked = io.BytesIO()
        with zipfile.ZipFile(repacked, "w") as copy:
            copy.writestr(indices[0], ElementTree.tostring(root))
            for name in set(archive.namelist()) - {indices[0]} - _checksum_files(indices[0], root):
                copy.writestr(name, archive.read(name))
    repacked.seek(0)
    return repacked, origin, notes


def _verify_index(archive, folder, index: bytes, root) -> tuple[str, ...]:
    """Compare the index with its checksum, which no longer holds once the root is renamed."""
    for name in _checksum_files(str(folder / _INDEX), root) & set(archive.namelist()):
        stated = archive.read(name).decode("ascii", errors="replace").split()
        if stated and stated[0].lower() != hashlib.md5(index, usedforsecurity=False).hexdigest():
            return (f"{NOTE}the MD5 checksum of {_INDEX} does not match{_CHANGED}",)
    return ()


def _checksum_files(index_name: str, root) -> set[str]:
    name = (root.findtext("Record4/ChecksumFile") or "").strip()
    return {str(PurePosixPath(index_name).parent / name)} if name else set()


def _regular(layer, origin: str, stated: dict) -> RawScan:
    """A grid; its axes may run backwards, its heights may have an offset."""
    dx, dy = layer.spacing
    heights = layer.z[:: 1 if dy > 0 else -1, :: 1 if dx > 0 else -1]
    heights = heights + layer.placement.offset[2]
    if layer.placement.has_rotation:
        note = "the file's rotation into global coordinates is ignored"
        stated["notes"] = (*stated["notes"], note)
    return RawScan(
        np.ascontiguousarray(heights),
        "matrix",
        spacing=(abs(dx), abs(dy)),
        first_row="top" if origin.startswith("N") else "bottom",
        **stated,
    )


FORMAT = Format(read_x3p, endings=(".x3p",), libraries=("x3pio", "defusedxml.ElementTree"))
