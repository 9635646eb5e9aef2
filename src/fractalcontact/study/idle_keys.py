"""Keys of a sidecar that would change nothing. Their writer meant a change, so they are refused."""

from collections.abc import Iterator, Mapping, Sequence

from ..core.directions import APERTURE, slides
from ..core.errors import InputError
from ..core.keys import schema_of
from ..scan.options import CONTACT_MAP, FACES
from .keys import SidecarKeys
from .scan_files import ScanFiles
from .sidecar import is_contact_map

#: Endings of files that hold one array without a name.
_UNNAMED = (".npy", ".csv", ".tsv", ".xyz", ".stl", ".ply", ".obj")


def refuse_idle_keys(scan: ScanFiles, keys: Mapping, settings: Mapping) -> None:
    """Refuse scan keys and settings of a sidecar that have no meaning for its files."""
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


def _keys_for(only: str) -> list[str]:
    """Keys that have a meaning only for some files or specimens."""
    keys = schema_of(SidecarKeys)["properties"]
    return [name for name, node in keys.items() if node.get("x-only") == only]


def _idle(scan: ScanFiles, keys: Mapping, settings: Mapping) -> Iterator[tuple[Sequence[str], str]]:
    """Keys without meaning for the kind of files, and the reason."""
    if is_contact_map(keys):
        solved = [key for key in settings if key != "label"]
        of_faces = [*_keys_for("pair"), *_keys_for("heights")]
        idle = [key for key in of_faces if key not in FACES]
        yield [*idle, *solved], "for a contact map, of which nothing is solved"
        return
    yield ["load"], "but for a contact map (did you mean 'loads'?)"
    yield _keys_for("contact map"), "but for a contact map (or write 'kind: contact-map')"
    if keys.get("kind") == APERTURE:
        yield ["opposite", "heights"], "for an aperture map, the opening between both faces"
    else:
        yield (
            _keys_for("map"),
            "but for a map of contact or aperture (write its 'kind')",
        )
    if scan.upper is not None:
        yield ["opposite"], "where both faces were scanned"
    else:
        yield _keys_for("pair"), "for one face, without an upper one"
    if not slides(settings.get("opposite", keys.get("kind"))):
        idle = _keys_for("sliding")
        yield idle, "for an aperture map or against a rigid plane: neither slides"
    if {"unit", "unit_xy", "unit_z"} <= set(keys):
        yield ["unit"], "beside both 'unit_xy' and 'unit_z'"
    if all(path.suffix.lower() in _UNNAMED for path in scan.files):
        ending = scan.lower.suffix.lower()
        yield ["variable"], f"for a {ending} file, which names no arrays"
