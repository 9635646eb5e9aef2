"""Which files of a folder make which specimen: by their names alone, nothing is opened."""

import re
from dataclasses import dataclass
from pathlib import Path

from .errors import InputError

SIDECAR_SUFFIXES = (".yaml", ".yml")
_IGNORED = ("README", "LICENSE")
_UNSAFE = re.compile(r"[^A-Za-z0-9_.-]")


@dataclass(frozen=True)
class ScanFiles:
    """The files of one specimen.

    Attributes
    ----------
    name : str
        The specimen's name, safe for paths and Snakemake wildcards.
    lower : Path
        The scan of the lower face, or the only one.
    upper : Path or None
        The scan of the upper face, if there is one.
    sidecar : Path or None
        What the user says about the scan, for both faces.
    original_name : str
        The name as the files spell it.
    """

    name: str
    lower: Path
    upper: Path | None
    sidecar: Path | None
    original_name: str


def specimen_name(original_name: str) -> str:
    """Make a name safe: letters, digits, ``_ . -``; neither dash nor dot in front."""
    return _UNSAFE.sub("_", original_name).lstrip("-.")


def split_file_name(file_name: str) -> tuple[str, str]:
    """Split a scan's or sidecar's file name into the specimen's name and the role of the file.

    Returns
    -------
    original_name : str
    role : {"only", "lower", "upper", "sidecar"}
    """
    path = Path(file_name)
    if path.suffix.lower() in SIDECAR_SUFFIXES:
        return path.stem, "sidecar"
    stem, _, face = path.stem.rpartition(".")
    if stem and face.lower() in ("lower", "upper"):
        return stem, face.lower()
    return path.stem, "only"


def find_scans(folder) -> dict[str, ScanFiles]:
    """List the specimens of a folder.

    ``NAME.ext`` is one face, ``NAME.lower.ext`` and ``NAME.upper.ext`` are two, ``NAME.yaml`` is
    the sidecar of either. Hidden files, README*, LICENSE* and sub-folders are passed over.

    Parameters
    ----------
    folder : path-like
        A folder that does not exist holds no scans.

    Returns
    -------
    dict of str to ScanFiles
        By specimen name, sorted.

    Raises
    ------
    InputError
        If two files claim one name, a face lacks its counterpart, a sidecar has no scan, a name has
        no usable character, or a link leads out of the folder.
    """
    scans, refused = list_scans(folder)
    for error in refused.values():
        raise error
    return scans


def list_scans(folder) -> tuple[dict[str, ScanFiles], dict[str, InputError]]:
    """List the specimens of a folder, and what is wrong with those that have none.

    Parameters
    ----------
    folder : path-like

    Returns
    -------
    scans : dict of str to ScanFiles
        As `find_scans` gives them.
    refused : dict of str to InputError
        By specimen name, or by file name where it gives none: the first thing wrong with each.
    """
    folder = Path(folder)
    if not folder.is_dir():
        return {}, {}
    roles: dict[str, dict[str, Path]] = {}
    refused: dict[str, InputError] = {}
    for path in sorted(folder.iterdir()):
        if path.name.startswith(".") or path.name.upper().startswith(_IGNORED) or path.is_dir():
            continue
        original_name, role = split_file_name(path.name)
        name = specimen_name(original_name)
        try:
            _refuse_outside_link(path, folder)
            if not name:
                raise InputError(f"{path}: give the file a name with letters or digits in it")
            of_specimen = roles.setdefault(name, {})
            if role in of_specimen:
                raise _two_claims(name, of_specimen[role], path)
            of_specimen[role] = path
        except InputError as error:
            refused.setdefault(name or path.name, error)
    scans = {}
    for name in sorted(roles.keys() - refused.keys()):
        try:
            scans[name] = _scan_files(name, roles[name])
        except InputError as error:
            refused[name] = error
    return scans, refused


def _scan_files(name: str, roles: dict[str, Path]) -> ScanFiles:
    """Check that the files of one specimen go together."""
    only, lower, upper = roles.get("only"), roles.get("lower"), roles.get("upper")
    sidecar = roles.get("sidecar")
    if only and (lower or upper):
        raise _two_claims(name, only, lower or upper)
    if not (only or lower or upper):
        raise InputError(
            f"{sidecar}: this sidecar has no scan; put {sidecar.stem}.<ext> (or "
            f"{sidecar.stem}.lower.<ext> and {sidecar.stem}.upper.<ext>) beside it, or remove it"
        )
    if bool(lower) != bool(upper):
        there, missing = (lower, "upper") if lower else (upper, "lower")
        original_name, _ = split_file_name(there.name)
        raise InputError(
            f"{there}: the {missing} face is missing; add {original_name}.{missing}{there.suffix}, "
            f"or rename this file {original_name}{there.suffix} if only one face was scanned"
        )
    lower = only or lower
    return ScanFiles(name, lower, upper, sidecar, split_file_name(lower.name)[0])


def _refuse_outside_link(path: Path, folder: Path) -> None:
    """A folder handed over by a stranger must not make the program read other files."""
    if path.is_symlink() and not path.resolve().is_relative_to(folder.resolve()):
        raise InputError(f"{path}: this link leads out of {folder}; copy the file itself here")
    if not path.is_file():
        raise InputError(f"{path}: not a readable file (a broken link?); remove or replace it")


def _two_claims(name: str, first: Path, second: Path) -> InputError:
    return InputError(
        f"{first.name} and {second.name} in {first.parent} both claim the specimen name {name!r}; "
        "rename one of them"
    )
