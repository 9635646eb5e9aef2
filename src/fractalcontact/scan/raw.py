"""Raw scan as every reader returns it, in the file's own units."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.labels import on_one_line
from ..core.units import length_unit

LARGEST_FILE = 4 * 1024**3  # bytes, also for what an archive inflates to or a header promises


@dataclass(frozen=True)
class RawScan:
    """Numbers of one file as its reader returns them, in the units of the file."""

    values: np.ndarray  # matrix (rows, columns) of heights, or points (n, 3)
    layout: str  # "matrix", "points" or "mesh"
    reader: str  # software or method that read the file
    unit_xy: str | None = None
    unit_z: str | None = None
    spacing: tuple[float, float] | None = None  # dx, dy that the file states, in `unit_xy`
    first_row: str | None = None  # "bottom" or "top"; None where the file states neither
    #: Direction of growing numbers, "up" or "down"; None where not stated.
    heights: str | None = None
    notes: tuple[str, ...] = ()  # for the user, about the reading
    triangles: np.ndarray | None = None  # (m, 3), rows of `values`; None for a cloud


class IncompleteSidecar(InputError):
    """Error of a file whose sidecar is absent or incomplete, with the lines of a ``draft``."""

    def __init__(self, message: str, draft: str):
        super().__init__(f"{message}\n{draft}")
        self.message, self.draft = message, draft


def refuse_larger(n_bytes: int, path: Path | str) -> None:
    """Refuse files that need more than `LARGEST_FILE`, before anything is allocated."""
    if n_bytes > LARGEST_FILE:
        raise InputError(
            f"{path}: {n_bytes / 1024**3:.1f} GiB to read, more than the "
            f"{LARGEST_FILE / 1024**3:g} GiB allowed; export a part of it or a coarser grid"
        )


@contextmanager
def reading(path: Path | str, kind: str) -> Iterator[None]:
    """Turn any error of a library on a damaged file into one `InputError` with its ``kind``."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:  # libraries raise anything over a file that was made to break them
        first = [*f"{error}".strip().splitlines(), ""][0]
        reason = on_one_line(f"{type(error).__name__}: {first}")
        raise InputError(f"{path}: not a readable {kind} ({reason}); export it again") from error


def stated_unit(text: object) -> str | None:
    """Unit of length that a file states; None for no unit or another quantity."""
    text = str(text or "").strip()
    return text if length_unit(text) else None
