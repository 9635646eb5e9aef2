"""Text grids of Surfer, which begin with DSAA."""

from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..draft import Hints
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger
from ..stated import Needs, require_stated

_MARK = b"DSAA"
_BLANK = 1.70141e38  # of a cell without height; versions differ in the last digits
_HEAD = 9  # words in front of the heights


def read_surfer(path: Path, options: ScanOptions) -> RawScan:
    """Read a text grid: its ranges go from the first node to the last, its first row is the lowest.

    Raises
    ------
    InputError
        If the file is damaged, or holds more or fewer heights than it says.
    """
    with reading(path, "Surfer text grid"):
        words = path.read_text(encoding="latin-1").replace(",", " ").split()
        nx, ny = int(words[1]), int(words[2])
        refuse_larger(8 * nx * ny, path)
        x_low, x_high, y_low, y_high = map(float, words[3:7])
        values = np.array(words[_HEAD:], dtype=float)
    if min(nx, ny) < 2 or values.size != nx * ny:
        raise InputError(
            f"{path}: its header promises {ny} rows of {nx} heights, it holds {values.size} "
            "heights; export it again"
        )
    require_stated(path, options, Needs(grid=True), Hints)
    values[values >= _BLANK * (1 - 1e-4)] = np.nan
    spacing = (x_high - x_low) / (nx - 1), (y_high - y_low) / (ny - 1)
    return RawScan(
        values.reshape(ny, nx),
        "matrix",
        reader="Surfer / DSAA",
        spacing=spacing,
        first_row="bottom",
    )


def is_surfer(path: Path) -> bool:
    """Recognise Surfer's text grids by their first word."""
    with open(path, "rb") as stream:
        return stream.read(len(_MARK)) == _MARK


FORMAT = Format(
    read_surfer,
    endings=(".grd", ".asc", ".dat", ".txt"),
    takes=is_surfer,
    refusal="no text grid of Surfer (DSAA); export it as ASCII grid, or as text x, y, z",
    memory_per_byte=60,
)
