"""Zip archives (.npz, .x3p, .plux, ...) as untrusted input, checked before any library opens them.

Nothing is ever unpacked to disk; the checks on names refuse files that were made to do harm there.
"""

import copy
import re
import stat
import zipfile
from pathlib import Path, PurePosixPath
from xml.parsers import expat

from ..core.errors import InputError
from .raw import reading, refuse_larger

MAX_MEMBERS = 10_000
#: No measured heights deflate better than this; a bomb does, up to 1 : 1032.
LARGEST_RATIO = 200
#: A few constant or empty members may: the ratio counts above this many bytes only.
UNSUSPICIOUS = 64 * 1024**2
LARGEST_XML = 512 * 1024**2  # bytes; 16 million heights written out
DEEPEST_XML = 100  # elements within elements
_CHUNK = 1024**2
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_ENCRYPTED = 0x1
_DRIVE = re.compile("[A-Za-z]:")


def check_archive(path: Path) -> None:
    """Refuse a harmful zip archive; other files pass.

    Every member is inflated once, piece by piece, since the directory of an archive can promise
    less than its members hold.

    Raises
    ------
    InputError
        If the archive is damaged or encrypted, names a member outside itself, twice or as a link,
        inflates to more than `LARGEST_FILE` or suspiciously well, or holds XML that declares
        entities or is nested without end.
    """
    if not zipfile.is_zipfile(path):
        return
    with reading(path, "archive"), zipfile.ZipFile(path) as archive:
        members = archive.infolist()
        _check_directory(members, path)
        for member in members:
            _check_content(archive, member, path)


def _check_directory(members: list[zipfile.ZipInfo], path: Path) -> None:
    """Check of an archive by its directory."""
    if len(members) > MAX_MEMBERS:
        raise InputError(
            f"{path}: an archive of {len(members)} members, more than the {MAX_MEMBERS} allowed; "
            "export the scan alone"
        )
    names = [member.filename for member in members]
    if len(set(names)) < len(names):
        double = next(name for name in names if names.count(name) > 1)
        raise InputError(f"{path}: the archive holds two members {double!r}; export the scan again")
    for member in members:
        _check_member(member, path)
    inflated = sum(member.file_size for member in members)
    packed = sum(member.compress_size for member in members)
    refuse_larger(inflated, path)
    if inflated > UNSUSPICIOUS and inflated > LARGEST_RATIO * packed:
        raise InputError(
            f"{path}: the archive inflates {inflated / max(packed, 1):.0f} times, as no measured "
            "surface does; export the scan again"
        )


def _check_member(member: zipfile.ZipInfo, path: Path) -> None:
    """Refuse a member that points elsewhere or cannot be read."""
    # Some Windows programs part folders by backslashes.
    name = PurePosixPath(member.filename.replace("\\", "/"))
    if name.is_absolute() or ".." in name.parts or _DRIVE.match(member.filename):
        raise InputError(
            f"{path}: its member {member.filename!r} points to a path outside the archive; do not "
            "use the file"
        )
    if stat.S_ISLNK(member.external_attr >> 16):
        raise InputError(f"{path}: its member {member.filename!r} is a link; export the scan again")
    if member.flag_bits & _ENCRYPTED:
        raise InputError(f"{path}: its member {member.filename!r} is encrypted; unlock it first")
    if member.compress_type not in _METHODS:
        raise InputError(
            f"{path}: its member {member.filename!r} is packed by an uncommon method "
            f"({member.compress_type}); pack it with 'deflate'"
        )


def _check_content(archive: zipfile.ZipFile, member: zipfile.ZipInfo, path: Path) -> None:
    """Inflate a member once and compare its size with the directory."""
    honest = copy.copy(member)
    honest.file_size += 2 * _CHUNK  # zipfile would cut off what comes after the promise
    xml = _XmlCheck(path, member) if member.filename.lower().endswith(".xml") else None
    size = 0
    with archive.open(honest) as stream:
        while (chunk := stream.read(_CHUNK)) and size <= member.file_size:
            size += len(chunk)
            if xml:
                xml.feed(chunk)
    if size != member.file_size:
        than = "more" if size > member.file_size else "less"
        raise InputError(
            f"{path}: its member {member.filename!r} holds {than} than the {member.file_size} "
            "bytes the archive promises; export the scan again"
        )


class _XmlCheck:
    """Scan of XML without building a tree, to refuse documents that overload a parser."""

    def __init__(self, path: Path, member: zipfile.ZipInfo):
        self.where = f"{path}: its {member.filename}"
        if member.file_size > LARGEST_XML:
            raise InputError(f"{self.where} is too large; export the heights in binary")
        self.depth = 0
        self.parser = expat.ParserCreate()
        self.parser.StartDoctypeDeclHandler = self._refuse_declarations
        self.parser.StartElementHandler = self._enter
        self.parser.EndElementHandler = self._leave

    def feed(self, chunk: bytes) -> None:
        self.parser.Parse(chunk)

    def _refuse_declarations(self, *_):
        raise InputError(f"{self.where} declares entities, which no scan needs")

    def _enter(self, *_):
        self.depth += 1
        if self.depth > DEEPEST_XML:
            raise InputError(f"{self.where} is nested more than {DEEPEST_XML} deep; it is no scan")

    def _leave(self, *_):
        self.depth -= 1
