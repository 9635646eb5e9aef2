"""Checks of the file itself: whether it is one, stays the same, and how much it holds."""

import hashlib
import os
import stat
import zipfile
from pathlib import Path

from ..core.errors import InputError
from .raw import reading, refuse_larger

#: Largest ratio by which a file inflates: no measured heights deflate better, and a bomb does, up
#: to 1 : 1032.
LARGEST_RATIO = 200
#: Bytes above which the ratio counts: a few constant or empty members may exceed it.
UNSUSPICIOUS = 64 * 1024**2


def regular_file(path: Path) -> os.stat_result:
    """Size and identity of a file; one that is absent, unreadable, empty or too large is refused.

    A pipe or a device is refused unopened: reading it could wait for ever.
    """
    try:
        status = path.stat()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: no such file, or it cannot be reached ({error})") from error
    if not stat.S_ISREG(status.st_mode):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a pipe, socket or device"
        raise InputError(f"{path}: {kind}, not a file; put the scan file itself here")
    if not os.access(path, os.R_OK):
        raise InputError(f"{path}: no permission to read it; allow it, 'chmod u+r' on the file")
    if status.st_size == 0:
        raise InputError(f"{path}: the file is empty")
    refuse_larger(status.st_size, path)
    return status


def is_unchanged(before: os.stat_result, after: os.stat_result) -> bool:
    """True if a file was neither written to nor replaced between two looks at it."""
    same = ("st_dev", "st_ino", "st_size", "st_mtime_ns")
    return all(getattr(before, key) == getattr(after, key) for key in same)


def inflated_size(path: Path) -> int:
    """Bytes of a file, or of the content of an archive (.npz, .x3p, ...) by its directory.

    Refused are far too many bytes, a ratio that no measured heights reach, and a damaged archive.
    """
    size = path.stat().st_size
    if zipfile.is_zipfile(path):
        with reading(path, "archive"), zipfile.ZipFile(path) as archive:
            inflated = sum(member.file_size for member in archive.infolist())
            packed = sum(member.compress_size for member in archive.infolist())
        size = max(size, inflated)
        refuse_larger(size, path)
        if inflated > UNSUSPICIOUS and inflated > LARGEST_RATIO * packed:
            raise InputError(
                f"{path}: the archive inflates {inflated / max(packed, 1):.0f} times, as no "
                "measured surface does; export the scan again"
            )
    return size


def require_whole(path: Path) -> None:
    """Refuse an archive with a member that is damaged, encrypted or not as long as promised.

    Names of members do not matter: nothing is ever unpacked to disk.
    """
    if zipfile.is_zipfile(path):
        with reading(path, "archive"), zipfile.ZipFile(path) as archive:
            if damaged := archive.testzip():
                raise InputError(f"{path}: its member {damaged!r} is damaged; export it again")


def sha256(path: Path) -> str:
    """Checksum of a file's content, in hexadecimal digits; a file that has gone is refused."""
    try:
        with open(path, "rb", opener=_without_waiting) as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{path}: no such file any more, it changed ({error})") from error


def _without_waiting(name, flags: int) -> int:
    """Open a file safely, even if it was replaced by a pipe meanwhile."""
    return os.open(name, flags | os.O_NONBLOCK)
