"""Surfaces in X3P containers (ISO 25178-72): regular or irregular, binary or inside the XML.

The reader of SurfaceTopography takes neither revisions after 2000, nor heights in the XML, nor
members in a sub-folder, all of which occur in files people share.
"""

import zipfile
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree

import numpy as np

from ..errors import InputError
from .raw import RawScan

_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}


def read_x3p(path: Path) -> RawScan:
    """Read the one layer of an X3P file; lengths are metres by the standard.

    Raises
    ------
    InputError
        If the archive or its index is damaged, or holds something other than one surface.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return _read_archive(archive, path)
    except InputError:
        raise
    except (zipfile.BadZipFile, ElementTree.ParseError, KeyError, ValueError, OSError) as error:
        raise InputError(f"{path}: not a readable X3P file ({error})") from error


def _read_archive(archive: zipfile.ZipFile, path: Path) -> RawScan:
    index_name = _index_member(archive, path)
    index = _parse_index(archive.read(index_name), path)
    if _text(index, "Record1/FeatureType") != "SUR":
        raise InputError(f"{path}: expected a surface (FeatureType SUR), not a profile or a cloud")
    if int(_text(index, "Record3/MatrixDimension/SizeZ", "1")) != 1:
        raise InputError(f"{path}: the file holds several layers; export one of them")
    size_x, size_y = (int(_text(index, f"Record3/MatrixDimension/Size{a}")) for a in "XY")
    absolute = {axis: _text(index, f"Record1/Axes/C{axis}/AxisType") == "A" for axis in "XYZ"}
    if absolute["X"] != absolute["Y"] or not absolute["Z"]:
        raise InputError(f"{path}: axes of mixed types are not supported; export a regular grid")
    if (data_list := index.find("Record3/DataList")) is not None:
        data = _from_list(data_list, 3 if absolute["X"] else 1)
    elif absolute["X"]:
        raise InputError(f"{path}: an irregular grid in binary; export a regular one or x, y, z")
    else:
        data = _from_members(archive, index, PurePosixPath(index_name).parent, size_x * size_y)
    if len(data) != size_x * size_y:
        raise InputError(f"{path}: {len(data)} points where its index promises {size_x * size_y}")
    axes = "XYZ" if absolute["X"] else "Z"
    for column, axis in enumerate(axes):
        increment = float(_text(index, f"Record1/Axes/C{axis}/Increment", "1"))
        data[:, column] = data[:, column] * increment + float(
            _text(index, f"Record1/Axes/C{axis}/Offset", "0")
        )
    stated = {"reader": "fractalcontact / x3p", "unit_xy": "m", "unit_z": "m"}
    if absolute["X"]:
        return RawScan(data, "points", **stated)
    spacing = tuple(float(_text(index, f"Record1/Axes/C{axis}/Increment")) for axis in "XY")
    first_row = "top" if _text(index, "Record1/Axes/Origin", "SW").startswith("N") else "bottom"
    heights = data.reshape(size_y, size_x)
    return RawScan(heights, "matrix", spacing=spacing, first_row=first_row, **stated)


def _index_member(archive: zipfile.ZipFile, path: Path) -> str:
    """Find main.xml, at the top or in the one folder somebody zipped."""
    found = [
        name
        for name in archive.namelist()
        if PurePosixPath(name).name == "main.xml" and not name.startswith("__MACOSX")
    ]
    if len(found) != 1:
        raise InputError(f"{path}: an X3P file has one main.xml, this one has {len(found)}")
    return found[0]


def _parse_index(xml: bytes, path: Path) -> ElementTree.Element:
    if b"<!DOCTYPE" in xml or b"<!ENTITY" in xml:  # entities can unfold without end
        raise InputError(f"{path}: its main.xml declares entities, which no X3P file needs")
    return ElementTree.fromstring(xml)


def _text(index: ElementTree.Element, tag: str, default: str | None = None) -> str:
    text = (index.findtext(tag) or "").strip()
    if text or default is not None:
        return text or default
    raise ValueError(f"{tag} is missing in main.xml")


def _from_list(data_list: ElementTree.Element, n_columns: int) -> np.ndarray:
    """Points written out in the XML; an empty one is a missing point."""
    missing = ";".join(["nan"] * n_columns)
    data = [datum.text or missing for datum in data_list.iter("Datum")]
    return np.array(";".join(data).split(";"), dtype=np.float64).reshape(len(data), n_columns)


def _from_members(archive, index, folder: PurePosixPath, n_points: int) -> np.ndarray:
    """Points in a binary member, and the bits that say which are valid, if any."""
    dtype = _TYPES[_text(index, "Record1/Axes/CZ/DataType")]
    link = _text(index, "Record3/DataLink/PointDataLink")
    heights = np.frombuffer(archive.read(str(folder / link)), dtype).astype(np.float64)
    if valid_link := _text(index, "Record3/DataLink/ValidPointsLink", ""):
        bits = np.frombuffer(archive.read(str(folder / valid_link)), np.uint8)
        valid = np.unpackbits(bits, bitorder="little")[:n_points].astype(bool)
        heights = np.where(valid, heights, np.nan)
    return heights[:, np.newaxis]
