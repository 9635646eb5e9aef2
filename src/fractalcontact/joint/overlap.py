"""Contact on suspicious cells of the scans: which nodes have them, and how much load they carry.

What is suspicious is found in :mod:`surface.suspect` and :mod:`surface.cleaning`; a node of a
composite topography is where either of its two cells is.
"""

import numpy as np
import xarray as xr

from ..core.determined import decided_by_scan
from ..core.labels import cf_attrs
from ..core.limits import RESOLVED_NODES
from ..core.reported import Reported
from ..core.window import window_slices
from .joint import slid_window


def suspect_nodes(specimen: xr.Dataset, direction: str, cells: int) -> np.ndarray:
    """Suspicious nodes (ny, nx) of the composite topography of the window at an offset in cells.

    Where the cell of either face is an outlier, a lone spike, filled, far from any point measured,
    or in a deep overlap. At zero offset also where the faces overlap at all: a node is there made
    of the two cells that were scanned at one place.
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


def on_sound_cells(curves: xr.Dataset) -> xr.DataArray:
    """States that fits take and that can seat a joint: ten nodes or more, on sound cells mostly.

    No more than half of the force acts on suspicious cells of the scans.
    """
    return curves["resolved"] & ~decided_by_scan(curves["suspect_load_share"])


def fits_undetermined(curves: xr.Dataset) -> xr.DataArray:
    """Curves whose fits rest on errors of the scans.

    Suspicious cells carry more than half of the load in half or more of the states that have the
    nodes to be fitted; of all states where none has.
    """
    decisive = decided_by_scan(curves["suspect_load_share"])
    enough = curves["nodes"] >= RESOLVED_NODES
    counted = enough.where(enough.any("normal_force"), curves["nodes"] > 0)
    states = counted.sum("normal_force")
    return (2 * (decisive & counted).sum("normal_force") >= states) & (states > 0)


def load_warning(curves: xr.Dataset, reported: Reported) -> str:
    """Warning where errors of the scans carry the load that decides a number, "" if nowhere.

    It names, for the reported direction and resolution, the offsets at which suspicious cells carry
    more than half of the reference load, and those at which they do so in half of the states of ten
    nodes, which no fit then takes.
    """
    finest = reported.curves(curves)
    mapped = finest["suspect_load_share"].isel(normal_force=reported.reference)
    parts = []
    worst = float(mapped.max())
    if decided_by_scan(worst):
        where = _offset_words(mapped["offset"].values[decided_by_scan(mapped.values)])
        at_maps = decided_by_scan(float(reported.at_offset(mapped)))
        maps = ", the reported offset among them" if at_maps else ""
        parts.append(f"up to {worst:.0%} of the reference load (v = {where} mm{maps})")
    fitted = fits_undetermined(finest)
    if fitted.any():
        where = _offset_words(fitted["offset"].values[fitted.values])
        states = f"half or more of the states of {RESOLVED_NODES} nodes"
        parts.append(f"most of the load in {states} (v = {where} mm)")
    if not parts:
        return ""
    return (
        f"suspicious cells of the scans carry {' and '.join(parts)}: "
        "closure, stiffness and contact are undetermined there"
    )


def _offset_words(offsets: np.ndarray) -> str:
    """Offsets in a list; of more than three only the ends."""
    words = [f"{offset:.3g}" for offset in offsets]
    return ", ".join(words) if len(words) <= 3 else f"{words[0]} ... {words[-1]}"
