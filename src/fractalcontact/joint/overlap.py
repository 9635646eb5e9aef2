"""Contact on suspicious cells of the scans: which nodes have them, and how much load they carry.

Suspicious cells are found in :mod:`surface.suspect` and :mod:`surface.cleaning`; a node of a
composite topography is suspicious where either of its two cells is.
"""

import numpy as np
import xarray as xr

from ..core.labels import cf_attrs
from ..core.window import window_slices
from .joint import slid_window


def suspect_nodes(specimen: xr.Dataset, direction: str, cells: int) -> np.ndarray:
    """Suspicious nodes (ny, nx) of the composite topography of the window at an offset in cells.

    A node is suspicious where the cell of either face is an outlier, a lone spike, filled, far from
    any point measured, or in a deep overlap. At zero offset it is also where the faces overlap at
    all: the two cells of a node were then scanned at one place.
    """
    window = window_slices(specimen)
    if "suspect_lower" not in specimen:
        return np.zeros([part.stop - part.start for part in window], dtype=bool)
    slid = slid_window(window, direction, cells)
    suspicious = specimen["suspect_lower"].values[slid].astype(bool)
    opposite = {"match": "suspect_lower", "scanned": "suspect_upper"}
    if specimen.attrs["opposite"] in opposite:
        other = specimen[opposite[specimen.attrs["opposite"]]].values
        suspicious = suspicious | other[window].astype(bool)
    if cells == 0:
        suspicious = suspicious | specimen["overlap"].values[window].astype(bool)
    return suspicious


def overlapping_nodes(specimen: xr.Dataset, direction: str, cells: int) -> np.ndarray:
    """Nodes (ny, nx) of the window at an offset in cells where the scanned faces overlap.

    The cell of either face lies in the overlap of the faces as scanned and registered.
    """
    window = window_slices(specimen)
    overlap = specimen["overlap"].values.astype(bool)
    return overlap[slid_window(window, direction, cells)] | overlap[window]


def node_marks(specimen: xr.Dataset, joint: xr.Dataset) -> dict[str, tuple]:
    """Marks of nodes that rest on overlapping or suspicious cells, as ``xr.Dataset`` takes them.

    ``node_mark`` (direction, offset, y_1, x_1) at the scan's own spacing: 2 where the faces overlap
    as scanned, 1 on otherwise suspicious cells, 0 elsewhere.
    """
    marks = [
        [
            np.where(
                overlapping_nodes(specimen, direction, n), 2, suspect_nodes(specimen, direction, n)
            )
            for n in joint["offset_cells"].sel(contact_direction=direction).values.tolist()
        ]
        for direction in joint["contact_direction"].values.tolist()
    ]
    words = "cells below a node: 2 in the overlap of the faces, 1 otherwise suspicious, 0 sound"
    dims = ("direction", "offset", "y_1", "x_1")
    return {"node_mark": (dims, np.array(marks, np.int8), cf_attrs("1", words))}


def suspect_load_share(pressure: np.ndarray, suspicious: np.ndarray) -> float:
    """Fraction of the force that suspicious nodes carry."""
    if not suspicious.any():
        return 0.0
    total = float(pressure.sum())
    return float(pressure[suspicious].sum()) / total if total > 0 else 0.0
