"""Curves that rest on errors of the scans: suspicious cells carry the load that decides them."""

import numpy as np
import xarray as xr

from ..core.determined import decided_by_scan
from ..core.limits import RESOLVED_NODES
from ..core.reported import Reported


def on_sound_cells(curves: xr.Dataset) -> xr.DataArray:
    """States that fits take and that can seat a joint: ten nodes or more, on sound cells mostly.

    No more than half of the force acts on suspicious cells of the scans.
    """
    return curves["resolved"] & ~decided_by_scan(curves["suspect_load_share"])


def fits_undetermined(curves: xr.Dataset) -> xr.DataArray:
    """Curves most of whose states rest on errors of the scans.

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
    nodes or more; no fit takes such a state.
    """
    finest = reported.curves(curves)
    shares = finest["suspect_load_share"].isel(normal_force=reported.reference)
    parts = []
    worst = float(shares.max())
    if decided_by_scan(worst):
        where = _offset_words(shares["offset"].values[decided_by_scan(shares.values)])
        at_maps = decided_by_scan(float(reported.at_offset(shares)))
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
