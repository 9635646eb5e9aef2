"""Vertices and triangles of STL, PLY and OBJ files."""

from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading


def read_mesh(path: Path, options: ScanOptions) -> RawScan:
    """Read a mesh, or the points of a PLY cloud.

    STL repeats each vertex in every triangle that meets there; the repeats are joined.

    Raises
    ------
    InputError
        If the file is damaged or holds no vertices.
    """
    import trimesh

    file_type = path.suffix.lstrip(".").lower()
    if file_type == "stl":
        _refuse_wrong_count(path)
    with reading(path, "mesh"), open(path, "rb") as stream:
        # From a stream, without a resolver: no other file it may name is opened.
        loaded = trimesh.load(stream, file_type=file_type, process=False, resolver=None)
        parts = list(loaded.geometry.values()) if hasattr(loaded, "geometry") else [loaded]
        vertices, triangles = _concatenate(parts)
    if not len(vertices):
        raise InputError(f"{path}: the mesh is empty: it holds no vertices")
    if len(triangles) and not (triangles.min() >= 0 and triangles.max() < len(vertices)):
        raise InputError(f"{path}: a damaged mesh: its triangles name vertices that it has not")
    if file_type == "stl":
        vertices, triangles = _join_repeats(vertices, triangles)
    return RawScan(
        vertices,
        "mesh",
        reader=f"trimesh {trimesh.__version__}",
        triangles=triangles if len(triangles) else None,
    )


def _refuse_wrong_count(path: Path) -> None:
    """Refuse a binary STL file whose number of triangles contradicts its header."""
    with open(path, "rb") as stream:
        head = stream.read(84)
    held, rest = divmod(path.stat().st_size - 84, 50)
    if head.lstrip().startswith(b"solid") or len(head) < 84 or rest:
        return
    stated = int.from_bytes(head[80:], "little")
    if stated != held:
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
