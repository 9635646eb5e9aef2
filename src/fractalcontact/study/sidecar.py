"""Text of a sidecar: plain YAML without anchors, and short, since it is untrusted input."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..scan.options import CONTACT_MAP
from .plain_yaml import load_yaml

LARGEST_SIDECAR = 64 * 1024  # bytes


def is_contact_map(scan_options: Mapping) -> bool:
    """True if a sidecar declares its file a map of contact."""
    return scan_options.get("kind") == CONTACT_MAP


def sidecar_of_matrix(spacing: float) -> dict[str, str]:
    """Scan keys of an array of heights in mm, rows ascending in y, at a spacing in mm."""
    return {
        "kind": "face",
        "layout": "matrix",
        "axes": "none",
        "unit": "mm",
        "spacing": f"{spacing:.12g} mm",
        "first_row": "bottom",
        "heights": "up",
        "missing": "none",
    }


def read_yaml(path: Path | str) -> dict:
    """Mapping in a YAML file, of plain data.

    Raises
    ------
    InputError
        If the file is too long, no YAML, or not a mapping.
    """
    try:
        with open(path, "rb") as stream:
            content = stream.read(LARGEST_SIDECAR + 1)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    if len(content) > LARGEST_SIDECAR:
        raise InputError(
            f"{path}: longer than the {LARGEST_SIDECAR // 1024} kB of a sidecar; write only the "
            "keys listed in scans/README.md"
        )
    document = load_yaml(content, path)
    if document is None:
        return {}
    if not isinstance(document, dict):
        raise InputError(f"{path}: expected 'key: value' lines, found {type(document).__name__}")
    return document


def plain_value(text: str, where: str) -> Any:
    """Value of a text as behind the key of a sidecar: "20 mm", "[1, 2]", "true"."""
    return load_yaml(text[:LARGEST_SIDECAR], where)
