"""Files that appear whole or not at all: the one writer of all results."""

import contextlib
import errno
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from .errors import OutputError

#: Beginning of the names of files that are being written; those of killed runs are swept.
UNFINISHED = ".unfinished-"
#: Free bytes of a disk below which an error in writing is put down to a full disk: the netCDF
#: library says no more than "HDF error" or "permission denied".
FULL_DISK = 2**20


@contextlib.contextmanager
def atomic_write(path: Path | str) -> Iterator[Path]:
    """Temporary path that takes the place of ``path`` when the block ends without error.

    Its content has reached the disk before it gets its name, so that a loss of power leaves the old
    file or the new one. A missing folder is made; folder and ending are those of ``path``.

    Raises
    ------
    OutputError
        If the disk is full or the folder cannot be written to. The old file stays.
    """
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=UNFINISHED, suffix=path.suffix)
    except OSError as error:
        raise _explained(path, error) from error
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        os.chmod(temporary, 0o666 & ~_umask())
        with open(temporary, "rb") as file:
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except Exception as error:
        if _is_full(path.parent, error):
            raise _unwritten(path, _NO_SPACE) from error
        if isinstance(error, PermissionError):
            raise _explained(path, error) from error
        raise
    finally:
        temporary.unlink(missing_ok=True)


def reach_disk(folders: Iterable[Path | str]) -> None:
    """Wait until the names in these folders have reached the disk, as the files' contents have."""
    for folder in sorted(set(folders)):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def sweep(folder: Path | str) -> list[Path]:
    """Remove half-written files of killed runs, while nothing writes there, and list them."""
    left = sorted(path for path in Path(folder).rglob(f"{UNFINISHED}*") if path.is_file())
    for path in left:
        path.unlink(missing_ok=True)
    return left


def _is_full(folder, error):
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return True
    return shutil.disk_usage(folder).free < FULL_DISK


_NO_SPACE = "no space left on its disk; make room there"


def _explained(path, error):
    """OutputError of a failed write, with its cause in words."""
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return _unwritten(path, _NO_SPACE)
    why = "no permission" if isinstance(error, PermissionError) else error.strerror or str(error)
    return _unwritten(path, f"{why}; allow writing there")


def _unwritten(path, why):
    return OutputError(f"{path}: cannot be written, {why} and run again")


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
