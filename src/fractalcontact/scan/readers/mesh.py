"""Vertices and triangles of STL, PLY and OBJ files."""

from pathlib import Path
from typing import BinaryIO

import numpy as np

from ...core.errors import InputError
from ..format import Format
from ..mesh_text import (
    MeshText,
    binary_stream,
    read_ascii_ply,
    read_obj,
    read_ply_header,
    refuse_cut_stl,
)
from ..options import ScanOptions
from ..raw import RawScan, reading


def read_mesh(path: Path, options: ScanOptions) -> RawScan:
    """Mesh, or the points of a PLY or OBJ cloud.

    STL repeats each vertex in every triangle that meets there; the repeats are joined.
    """
    file_type = path.suffix.lstrip(".").lower()
    with open(path, "rb") as stream:
        if file_type == "obj":
            mesh, reader = read_obj(path), "OBJ / text"
        elif file_type == "stl":
            _refuse_wrong_count(path)
            mesh, reader = _by_trimesh(stream, path, file_type)
        elif (header := read_ply_header(stream, path)).is_ascii:
            mesh, reader = read_ascii_ply(stream, header, path), "PLY / text"
        else:
            mesh, reader = _by_trimesh(binary_stream(stream, header), path, file_type)
    vertices, triangles, notes = mesh
    if not len(vertices):
        raise InputError(f"{path}: the mesh is empty: it holds no vertices")
    if len(triangles) and not (triangles.min() >= 0 and triangles.max() < len(vertices)):
        raise InputError(f"{path}: a damaged mesh: its triangles name vertices that it has not")
    if file_type == "stl":
        vertices, triangles = _join_repeats(vertices, triangles)
    return RawScan(
        vertices,
        "mesh",
        reader=reader,
        notes=notes,
        triangles=triangles if len(triangles) else None,
    )


def _by_trimesh(stream: BinaryIO, path: Path, file_type: str) -> tuple[MeshText, str]:
    """Vertices and triangles of all parts, and the reader."""
    import trimesh

    with reading(path, "mesh"):
        # From a stream, without a resolver: no other file it may name is opened.
        loaded = trimesh.load(stream, file_type=file_type, process=False, resolver=None)
        parts = list(loaded.geometry.values()) if hasattr(loaded, "geometry") else [loaded]
        return MeshText(*_concatenate(parts), ()), f"trimesh {trimesh.__version__}"


def _refuse_wrong_count(path: Path) -> None:
    """Refuse an STL file whose number of triangles is not that of its header or of its lines."""
    with open(path, "rb") as stream:
        head = stream.read(84)
    held, rest = divmod(path.stat().st_size - 84, 50)
    stated = int.from_bytes(head[80:], "little")
    if head.lstrip().startswith(b"solid") and (rest or stated != held):
        refuse_cut_stl(path)
    elif len(head) == 84 and not rest and stated != held:
        raise InputError(
            f"{path}: its header states {stated} triangles, the file holds {held}; export it again"
        )


def _concatenate(parts) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of all parts, the triangles counted on."""
    vertices, triangles, before = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.int64)], 0
    for part in parts:
        vertices.append(np.asarray(part.vertices, dtype=np.float64))
        if len(getattr(part, "faces", ())):
            triangles.append(np.asarray(part.faces, dtype=np.int64) + before)
        before += len(vertices[-1])
    return np.concatenate(vertices), np.concatenate(triangles)


def _join_repeats(vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give vertices at the same place one number; in order of x, y, z."""
    order = np.lexsort(vertices.T[::-1])
    ordered = vertices[order]
    first = np.r_[True, (ordered[1:] != ordered[:-1]).any(axis=1)]
    number = np.empty(len(vertices), dtype=np.int64)
    number[order] = np.cumsum(first) - 1
    return ordered[first], number[triangles]


FORMAT = Format(
    read_mesh,
    endings=(".obj", ".ply", ".stl"),
    libraries=("trimesh", "trimesh.exchange.load"),
)
