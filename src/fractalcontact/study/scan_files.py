"""Specimens from the names of files in a folder, without opening any."""

import re
import unicodedata
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.file_names import SIDECAR_SUFFIXES, specimen_name, split_file_name
from ..core.labels import printable

_IGNORED = ("README", "LICENSE")
#: Names, endings and beginnings, in lower case, of files that systems and editors leave behind.
_LEFT_BY_SYSTEMS = ("thumbs.db", "desktop.ini", "icon\r", "ehthumbs.db")
_LEFT_BEHIND = (
    *("~", ".bak", ".orig", ".rej", ".tmp", ".swp", ".swo", ".save", ".asv", ".autosave"),
    *(".part", ".partial", ".filepart", ".crdownload", ".download", ".opdownload"),
)
#: Endings of drafts of sidecars and pictures, which `make describe` writes and nothing reads.
DRAFTS = (".draft.yaml", ".draft.png", ".draft.html")
_DRAFT = ".draft"
_LOCKS = ("~$", "._", ".~lock.")
#: Emacs' ``#rock.npy#`` and nano's ``rock.npy.save.1``.
_SAVED_BY_EDITORS = re.compile(r"#[^#]{1,250}#|[^#]{1,240}\.save\.\d{1,3}")
#: Other names of the lower face of a joint and of its upper one.
_OTHER_FACE = {"lower": "upper", "bottom": "top", "sidea": "sideb", "side1": "side2"}
_FACE = re.compile(r"(?:[_ -]|(?<=[a-z0-9])(?=[A-Z]))(?i:lower|bottom|side[a1])(?![a-zA-Z0-9])")
#: Longest name of a specimen. Results have this name and a few letters more, and file systems take
#: names of 255 bytes.
LONGEST_NAME = 220
#: Unicode categories of control characters, invisible and direction marks, undecodable bytes and
#: line separators.
_INVISIBLE = ("Cc", "Cf", "Cs", "Zl", "Zp")


@dataclass(frozen=True)
class ScanFiles:
    """Files of one specimen.

    Attributes
    ----------
    name : str
        The specimen's name, safe for paths and Snakemake wildcards.
    lower : Path
        The scan of the lower face, or the only one.
    upper : Path or None
        The scan of the upper face, if there is one.
    sidecar : Path or None
        Statements of the user on the scan, for both faces.
    coordinates : tuple of Path
        Files of x and y of a contact map, where its sidecar names them.
    group : str
        Folder of its group; empty where there are none.
    shared : Path or None
        Sidecar of that folder.
    row : mapping of str to object
        Keys that a table states of it, as a sidecar would.
    row_of : str
        Table and line of that, for errors.
    """

    name: str
    lower: Path
    upper: Path | None
    sidecar: Path | None
    coordinates: tuple[Path, ...] = ()
    group: str = ""
    shared: Path | None = None
    row: Mapping[str, Any] = field(default_factory=dict)
    row_of: str = ""

    @property
    def said_in(self) -> Path | str | None:
        """Source to name in errors: a table, its sidecar, or that of its group."""
        return self.row_of or self.sidecar or self.shared

    @property
    def files(self) -> tuple[Path, ...]:
        """All measured files of a specimen, without the sidecar."""
        return tuple(path for path in (self.lower, self.upper, *self.coordinates) if path)


def list_scans(
    folder: Path | str, group_folders: Collection[str] = ()
) -> tuple[dict[str, ScanFiles], dict[str, InputError]]:
    """Specimens of a folder by name, sorted, and errors of its other files.

    ``NAME.ext`` is one face, ``NAME.lower.ext`` and ``NAME.upper.ext`` are two, ``NAME.yaml`` is
    the sidecar of either. Hidden files, README*, LICENSE*, sub-folders and files left behind by
    systems and editors are passed over (:func:`folder_notes`). ``group_folders`` are folders that
    are groups of specimens: a sidecar NAME.yaml of one is no scan's.

    Errors, by specimen name or else by file name, are of the first fault of each: two files claim
    one name, or names differ in case alone; a face lacks its counterpart, a sidecar has no scan; a
    name is too long, has no usable character, invisible ones or braces; a link leads out of the
    folder; a file is a pipe or a device, or a folder has the name of a scan file.

    Raises
    ------
    InputError
        If the folder does not exist.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(
            f"{folder}: no such folder (not mounted?); make it, name another one under 'scans' in "
            "the study, or write 'scans: null' if it has none"
        )
    roles: dict[str, dict[str, Path]] = {}
    refused: dict[str, InputError] = {}
    for path in sorted(folder.iterdir()):
        if is_passed_over(path.name):
            continue
        if path.stem in group_folders and path.suffix.lower() in SIDECAR_SUFFIXES:
            continue
        if path.is_dir():
            if path.name not in group_folders and _is_named_like_a_scan(path):
                refused[path.name] = InputError(
                    f"{path}: a folder, not a file; put the scan file itself here, or rename it"
                )
            continue
        original_name, role = split_file_name(path.name)
        name = specimen_name(original_name)
        try:
            refuse_misleading(path)
            refuse_outside_link(path, folder)
            refuse_unusable(name, path)
            of_specimen = roles.setdefault(name, {})
            if role in of_specimen:
                raise _two_claims(name, of_specimen[role], path)
            of_specimen[role] = path
        except InputError as error:
            refused.setdefault(name or path.name, error)
    refused |= case_alone(roles)
    scans = {}
    for name in sorted(roles.keys() - refused.keys()):
        try:
            scans[name] = _scan_files(name, roles[name])
        except InputError as error:
            refused[name] = error
    return scans, refused


def folder_notes(folder: Path | str) -> list[str]:
    """Notes on the names in a folder, a sentence each: files passed over, pairs that are none."""
    folder = Path(folder)
    if not folder.is_dir():
        return []
    names = sorted(path.name for path in folder.iterdir() if path.is_file())
    left = [name for name in names if _is_left_behind(name)]
    notes = []
    if left:
        some = ", ".join(map(printable, left))
        notes.append(f"{folder}: passed over, as systems and editors leave such files: {some}")
    notes += [
        f"{folder}: {printable(lower)} and {printable(upper)} are taken as two specimens of one "
        f"face each; if they are the faces of one joint, rename them {printable(new_lower)} and "
        f"{printable(new_upper)}"
        for lower, upper, new_lower, new_upper in _likely_pairs(names)
    ]
    return notes


def is_passed_over(name: str) -> bool:
    """True if a file or folder of this name is passed over: hidden ones, README*, drafts."""
    hidden = name.startswith(".") or name.upper().startswith(_IGNORED)
    return hidden or _is_left_behind(name) or name.lower().endswith(DRAFTS)


def _is_left_behind(name: str) -> bool:
    name = name.lower()
    is_listed = name in _LEFT_BY_SYSTEMS or name.endswith(_LEFT_BEHIND) or name.startswith(_LOCKS)
    return is_listed or bool(_SAVED_BY_EDITORS.fullmatch(name))


def _likely_pairs(names: list[str]) -> Iterator[tuple[str, str, str, str]]:
    """Two files named like faces of one joint but in another form, and their right names.

    Examples are ``rock_lower.xyz`` and ``rock_upper.xyz``, or ``rock-bottom.x3p`` and
    ``rock-top.x3p``.
    """
    spelled = {name.lower(): name for name in names}
    for name in names:
        stem, ending = Path(name).stem, Path(name).suffix
        if not _FACE.search(stem) or ending.lower() in SIDECAR_SUFFIXES:
            continue
        other = spelled.get(f"{_FACE.sub(_turned, stem)}{ending}".lower())
        common = _FACE.sub("", stem)
        if other and common and other != name:
            yield name, other, f"{common}.lower{ending}", f"{common}.upper{ending}"


def _turned(face: re.Match) -> str:
    """Word for the other face, with its separator."""
    word = face[0].lstrip("_ -")
    return face[0].removesuffix(word) + _OTHER_FACE[word.lower()]


def _is_named_like_a_scan(folder: Path) -> bool:
    """True if a folder is likely to be an archive that somebody unpacked."""
    if not folder.suffix:
        return False
    from ..scan.formats import known_extensions  # of all readers, and hardly ever needed

    return folder.suffix.lower() in known_extensions()


def refuse_misleading(path: Path) -> None:
    """Refuse names that look like others or act on a terminal; errors do not repeat them."""
    if any(unicodedata.category(character) in _INVISIBLE for character in path.name):
        raise InputError(
            f"{path.parent}: the file name {path.name!a} has invisible characters (line "
            "breaks, control or direction marks); rename the file"
        )
    if set("{}") & set(path.name):
        raise InputError(f"{path}: a file name must not contain braces; rename the file")


def refuse_unusable(name: str, path: Path) -> None:
    """Refuse a specimen's name that is empty, a draft's, or too long for its results."""
    if not name:
        raise InputError(f"{path}: give the file a name with letters or digits in it")
    if name.lower().endswith(_DRAFT):
        raise InputError(
            f"{path}: a specimen called {name}, whose sidecar {name}.yaml would be taken for a "
            f"draft; rename the file, such as {name[: -len(_DRAFT)]}_draft{path.suffix}"
        )
    if len(name) > LONGEST_NAME:
        raise InputError(
            f"{path}: a specimen name of {len(name)} characters, more than the {LONGEST_NAME} that "
            "leave room for the names of its results; shorten the file's name"
        )


def case_alone(roles: dict[str, dict[str, Path]]) -> dict[str, InputError]:
    """Errors of names that differ in upper and lower case alone, by name.

    On many disks Rock.nc and rock.nc are one file: one result would overwrite the other.
    """
    spelled: dict[str, str] = {}
    refused = {}
    for name in roles:
        other = spelled.setdefault(name.lower(), name)
        if other != name:
            first, second = (next(iter(roles[n].values())) for n in (other, name))
            refused[name] = InputError(
                f"{first.name} and {second.name} in {first.parent} differ in upper and lower case "
                "alone; rename one, or spell both the same if they belong together"
            )
    return refused


def _scan_files(name: str, roles: dict[str, Path]) -> ScanFiles:
    """Files of one specimen, which must go together."""
    only, lower, upper = roles.get("only"), roles.get("lower"), roles.get("upper")
    face = lower or upper
    if only and face:
        raise _two_claims(name, only, face)
    first = only or face
    if first is None:
        raise _without_scan(roles["sidecar"])
    original_name, _ = split_file_name(first.name)
    if not only and not (lower and upper):
        missing = "upper" if lower else "lower"
        raise InputError(
            f"{first}: the {missing} face is missing; add {original_name}.{missing}{first.suffix}, "
            f"or rename this file {original_name}{first.suffix} if only one face was scanned"
        )
    return ScanFiles(name, first, upper, roles.get("sidecar"))


def _without_scan(sidecar: Path) -> InputError:
    stem, _, face = sidecar.stem.rpartition(".")
    if stem and face.lower() in ("lower", "upper"):
        return InputError(
            f"{sidecar}: one sidecar serves both faces of a joint; rename it {stem}.yaml"
        )
    folders = [path.name for path in sidecar.parent.glob("*/") if path.stem == sidecar.stem]
    hint = (
        f"; {folders[0]} is a folder, which is looked into only where the study says 'groups: "
        "folders'"
        if folders
        else ""
    )
    names = sorted(path.name for path in sidecar.parent.iterdir())
    for lower, upper, new_lower, new_upper in _likely_pairs(names):
        if new_lower == f"{sidecar.stem}.lower{Path(lower).suffix}":
            hint = f"; {lower} and {upper} are its faces if they are called {new_lower} and "
            hint += new_upper
    return InputError(
        f"{sidecar}: this sidecar has no scan; put {sidecar.stem}.<ext> (or "
        f"{sidecar.stem}.lower.<ext> and {sidecar.stem}.upper.<ext>) beside it, or remove it{hint}"
    )


def refuse_outside_link(path: Path, folder: Path) -> None:
    """Refuse links out of a folder: an untrusted folder could otherwise have other files read."""
    try:
        target = path.resolve(strict=True)
    except (OSError, RuntimeError) as error:  # a loop is one or the other, by version of Python
        raise InputError(
            f"{path}: not a readable file (a broken link?); remove or replace it"
        ) from error
    if path.is_symlink() and not target.is_relative_to(folder.resolve()):
        raise InputError(f"{path}: this link leads out of {folder}; copy the file itself here")
    if not target.is_file():
        raise InputError(f"{path}: a pipe, socket or device, not a file; remove it")


def _two_claims(name: str, first: Path, second: Path) -> InputError:
    return InputError(
        f"{first.name} and {second.name} in {first.parent} both claim the specimen name {name!r}; "
        "rename one of them"
    )
