"""A scan in mm, before it is on a grid, and the notes on it that a user should act on."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

#: Begins a note that a user should act on: it is also among the ``warnings``.
NOTE = "NOTE: "


def warnings_of(notes: Iterable[str]) -> str:
    """Notes that a user should act on, one a line."""
    return "\n".join(note.removeprefix(NOTE) for note in notes if note.startswith(NOTE))


@dataclass(frozen=True)
class UngriddedScan:
    """A scan in mm, before it is on a grid.

    Attributes
    ----------
    path : Path
    layout : {"matrix", "points", "mesh"}
    values : ndarray
        Heights (ny, nx), first row at the smallest y; or points (n, 3).
    spacing : (float, float) or None
        dx, dy of a matrix.
    grid : float or None
        Spacing to grid points at, where the user gives it.
    provenance : dict
        Attributes for the result.
    triangles : (m, 3) int ndarray or None
        Of a mesh, between the points.
    level : bool
        False of an aperture map, whose tilt is a wedge of the joint: a cloud is not turned level.
    size : dict
        Rows and columns or points, and relief in the numbers of the file: what an owner confirms.
    """

    path: Path
    layout: str
    values: np.ndarray
    spacing: tuple[float, float] | None
    grid: float | None
    provenance: dict
    triangles: np.ndarray | None = None
    level: bool = True
    size: dict = field(default_factory=dict)
