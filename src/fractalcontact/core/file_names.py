"""Names of scan files: specimen and face of a file, by its name alone."""

import hashlib
import re
import unicodedata
from pathlib import Path

SIDECAR_SUFFIXES = (".yaml", ".yml")


_UNSAFE = re.compile(r"[^A-Za-z0-9_.-]")


#: Names by which Windows opens devices, whatever the ending: it cannot copy files of such names.
_DEVICES = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\.|$)")


#: Repetitive ending, which Snakemake takes for a rule that consumes its own output; long names in
#: other alphabets end in a row of ``_``.
_REPEATS = re.compile(r"(.+?)\1{19}$")


def specimen_name(original_name: str) -> str:
    """Name of a specimen with safe characters: letters, digits, ``_ . -``; no dash or dot in front.

    Composed and decomposed accents, which look the same, give the same name. A name that Windows
    keeps for a device gets ``_`` in front, one that ends in many repeats six letters behind.
    """
    composed = unicodedata.normalize("NFC", original_name)
    name = _UNSAFE.sub("_", composed).lstrip("-.")
    if _REPEATS.search(name):
        name += f"-{hashlib.sha256(composed.encode(errors='surrogateescape')).hexdigest()[:6]}"
    return f"_{name}" if _DEVICES.match(name) else name


def split_file_name(file_name: str) -> tuple[str, str]:
    """Specimen's name and role ("only", "lower", "upper", "sidecar") of a scan file or sidecar."""
    path = Path(file_name)
    if path.suffix.lower() in SIDECAR_SUFFIXES:
        return path.stem, "sidecar"
    stem, _, face = path.stem.rpartition(".")
    if stem and face.lower() in ("lower", "upper"):
        return stem, face.lower()
    return path.stem, "only"
