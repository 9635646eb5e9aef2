"""Vertices of STL, PLY and OBJ files."""

from pathlib import Path

import numpy as np

from ..errors import InputError
from .raw import RawScan


def read_mesh(path: Path) -> RawScan:
    """Read the vertices of a mesh or of a PLY cloud; the triangles are not used.

    The faces of a fracture are scanned from above, so the vertices are samples of a height. STL
    repeats each vertex in every triangle that meets there; gridding merges them.

    Raises
    ------
    InputError
        If the file is damaged or holds no vertices.
    """
    import trimesh

    try:
        with open(path, "rb") as stream:
            # From a stream, without a resolver: no other file it may name is opened.
            loaded = trimesh.load(
                stream, file_type=path.suffix.lstrip(".").lower(), process=False, resolver=None
            )
    except Exception as error:  # a damaged file makes trimesh raise anything
        raise InputError(f"{path}: not a readable mesh ({error})") from error
    parts = loaded.geometry.values() if hasattr(loaded, "geometry") else [loaded]
    vertices = [np.asarray(part.vertices, dtype=np.float64) for part in parts]
    if not sum(len(v) for v in vertices):
        raise InputError(f"{path}: the mesh is empty: it holds no vertices")
    return RawScan(np.concatenate(vertices), "mesh", reader=f"trimesh {trimesh.__version__}")
