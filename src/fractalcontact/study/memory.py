"""Memory that the job of a specimen asks for, from the sizes of its scan files."""

from collections.abc import Iterable
from pathlib import Path

#: Megabytes of a job whatever its file: the program and its libraries, and what a small scan takes.
LEAST = 2000
#: Megabytes of the program and its libraries, of which the reader process has as many.
_PROGRAM = 700
#: Bytes of memory for each byte of a file of plain numbers: 12 million points
#: x, y, z (315 MB as text, 288 MB as they are) take some 2 GB, those of a scattered cloud more.
_PLAIN = 8
#: Bytes of memory for each byte of any other file: heights in two bytes, or packed to one.
_PACKED = 60
_PLAIN_ENDINGS = {".asc", ".csv", ".dat", ".npy", ".obj", ".ply", ".stl", ".tsv", ".txt", ".xyz"}


def specimen_memory(files: Iterable[Path | str]) -> int:
    """Megabytes to ask for, to read the faces of a specimen, grid, clean and describe them.

    Parameters
    ----------
    files : iterable of path-like
        One face or two. Those that are not there, which the job explains, count as empty.
    """
    needed = 0.0
    for path in map(Path, files):
        size = path.stat().st_size if path.is_file() else 0
        needed += size * (_PLAIN if path.suffix.lower() in _PLAIN_ENDINGS else _PACKED)
    return max(LEAST, round(_PROGRAM + needed / 1e6))
