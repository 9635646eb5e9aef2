"""Keys of a sidecar that would change nothing: they were meant to, so they are refused."""

from collections.abc import Mapping, Sequence

from ..core.errors import InputError
from .scan_files import ScanFiles
from .sidecar import is_contact_map

#: Scan keys of contact maps alone.
_OF_MAPS = ("threshold", "outline", "series", "x", "y", "cells", "load")
#: Settings that a measured contact map has; nothing is solved of it.
_SETTINGS_OF_MAPS = ("label",)
#: Scan keys that say how two faces lie to each other, or how points become a grid.
_NOT_OF_MAPS = ("registration", "mirror_upper", "grid", "columns", "unit_z")
#: Settings of sliding, which a surface against a plane does not do.
_OF_SLIDING = ("directions", "contact_directions", "offsets", "map_offset")
#: Endings of files that hold one array without a name.
_UNNAMED = (".npy", ".csv", ".tsv", ".xyz", ".stl", ".ply", ".obj")


def refuse_idle_keys(scan: ScanFiles, keys: Mapping, settings: Mapping) -> None:
    """Refuse keys that have no meaning for what the files of a specimen are.

    Parameters
    ----------
    scan : ScanFiles
    keys, settings : mapping
        Scan keys and settings of its sidecar.

    Raises
    ------
    InputError
        For the first of them.
    """
    if scan.sidecar is None and not scan.row:
        return
    if is_contact_map(keys):
        if scan.upper is not None:
            raise InputError(
                f"{_where(scan)}: a contact map is one file, here are two faces; remove "
                "'kind: contact-map', or one of the files"
            )
        idle = _first(_NOT_OF_MAPS, keys) or next(
            (key for key in settings if key not in _SETTINGS_OF_MAPS), ""
        )
        _refuse(scan, idle, "for a contact map, of which nothing is solved")
        return
    if key := _first(_OF_MAPS, keys):
        meant = "did you mean 'loads'?" if key == "load" else "or write 'kind: contact-map'"
        _refuse(scan, key, "but for a contact map", meant)
    if scan.upper is not None:
        _refuse(scan, _first(("opposite",), settings), "where both faces were scanned")
    else:
        _refuse(
            scan,
            _first(("registration", "mirror_upper"), keys),
            "for one face, without an upper one",
        )
    if settings.get("opposite") == "flat":
        _refuse(
            scan, _first(_OF_SLIDING, settings), "against a rigid plane, on which nothing slides"
        )
    if {"unit", "unit_xy", "unit_z"} <= set(keys):
        _refuse(scan, "unit", "beside both 'unit_xy' and 'unit_z'")
    if all(path.suffix.lower() in _UNNAMED for path in scan.files):
        ending = scan.lower.suffix.lower()
        _refuse(scan, _first(("variable",), keys), f"for a {ending} file, which names no arrays")


def _where(scan: ScanFiles) -> object:
    """What says it: a table comes last, and so says it where there is one."""
    return scan.row_of or scan.sidecar


def _first(names: Sequence[str], stated: Mapping) -> str:
    return next((name for name in names if name in stated), "")


def _refuse(scan: ScanFiles, key: str, why: str, otherwise: str = "") -> None:
    if key:
        hint = f" ({otherwise})" if otherwise else ""
        raise InputError(f"{_where(scan)}: key '{key}' has no meaning {why}; remove it{hint}")
