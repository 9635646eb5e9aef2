"""Keys of a sidecar that would change nothing: they were meant to, so they are refused."""

from collections.abc import Iterator, Mapping, Sequence

from ..core.directions import APERTURE, slides
from ..core.errors import InputError
from ..scan.options import CONTACT_MAP
from .scan_files import ScanFiles
from .sidecar import is_contact_map

#: Endings of files that hold one array without a name.
_UNNAMED = (".npy", ".csv", ".tsv", ".xyz", ".stl", ".ply", ".obj")


def refuse_idle_keys(scan: ScanFiles, keys: Mapping, settings: Mapping) -> None:
    """Refuse keys without meaning for the files of a specimen.

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
    kind = keys.get("kind")
    if kind in (CONTACT_MAP, APERTURE) and scan.upper is not None:
        raise InputError(
            f"{scan.said_in}: a map of contact or aperture is one file, here are two faces; remove "
            f"'kind: {kind}', or one of the files"
        )
    for idle, why in _idle(scan, keys, settings):
        for key in idle:
            if key in keys or key in settings:
                raise InputError(f"{scan.said_in}: key '{key}' has no meaning {why}; remove it")


def _idle(scan: ScanFiles, keys: Mapping, settings: Mapping) -> Iterator[tuple[Sequence[str], str]]:
    """Keys without meaning for the kind of files, and the reason."""
    if is_contact_map(keys):
        solved = [key for key in settings if key != "label"]
        how_faces_lie = ["registration", "mirror_upper", "grid", "columns", "unit_z", "heights"]
        yield [*how_faces_lie, *solved], "for a contact map, of which nothing is solved"
        return
    yield ["load"], "but for a contact map (did you mean 'loads'?)"
    of_maps = ["threshold", "series", "x", "y", "cells"]
    yield of_maps, "but for a contact map (or write 'kind: contact-map')"
    if keys.get("kind") == APERTURE:
        yield ["opposite", "heights"], "for an aperture map, the opening between both faces"
    else:
        yield (
            ["outline"],
            "but for a map of contact or aperture (write its 'kind')",
        )
    if scan.upper is not None:
        yield ["opposite"], "where both faces were scanned"
    else:
        of_pairs = ["registration", "mirror_upper", "lower", "upper"]
        yield of_pairs, "for one face, without an upper one"
    if not slides(settings.get("opposite", keys.get("kind"))):
        sliding = ["directions", "contact_directions", "offsets", "map_offset"]
        yield sliding, "for an aperture map or against a rigid plane: neither slides"
    if {"unit", "unit_xy", "unit_z"} <= set(keys):
        yield ["unit"], "beside both 'unit_xy' and 'unit_z'"
    if all(path.suffix.lower() in _UNNAMED for path in scan.files):
        ending = scan.lower.suffix.lower()
        yield ["variable"], f"for a {ending} file, which names no arrays"
