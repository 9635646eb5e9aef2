"""Text grids of Surfer, which begin with DSAA."""

from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..draft import Hints
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger
from ..stated import Needs, require_stated
from ..text_lines import MAX_ROWS, notes_on_end

_MARK = b"DSAA"
#: A cell without height holds 1.70141e38; versions differ in the last digits.
_BLANK = 1.70141e38 * (1 - 1e-4)
_HEAD = 9  # words in front of the heights
_ROUNDED = 1e-3  # of the range that a header states: programs round it


def read_surfer(path: Path, options: ScanOptions) -> RawScan:
    """Heights of a text grid; its ranges go from first to last node, the lowest row first."""
    with reading(path, "Surfer text grid"):
        content = path.read_text(encoding="latin-1")
        words = content.replace(",", " ").split()
        nx, ny = int(words[1]), int(words[2])
        refuse_larger(8 * nx * ny, path)
        x_low, x_high, y_low, y_high, z_low, z_high = map(float, words[3:_HEAD])
        values = np.array(words[_HEAD:], dtype=float)
    if min(nx, ny) < 2 or values.size != nx * ny:
        raise InputError(
            f"{path}: its header promises {ny} rows of {nx} heights, it holds {values.size} "
            "heights; export it again"
        )
    require_stated(path, options, Needs(grid=True), Hints)
    notes: tuple[str, ...] = ()
    if values[-1] < _BLANK:
        latest = zip(words[_HEAD:][-MAX_ROWS:], values[-MAX_ROWS:], strict=True)
        heights = [word for word, value in latest if value < _BLANK]
        notes = notes_on_end(heights, content, path)
    values[values >= _BLANK] = np.nan
    notes += _notes_on_range(values, z_low, z_high, path)
    spacing = (x_high - x_low) / (nx - 1), (y_high - y_low) / (ny - 1)
    return RawScan(
        values.reshape(ny, nx),
        "matrix",
        reader="Surfer / DSAA",
        spacing=spacing,
        first_row="bottom",
        notes=notes,
    )


def _notes_on_range(values: np.ndarray, low: float, high: float, path: Path) -> tuple[str, ...]:
    """Note on heights outside the range that the header states.

    A single height outside the range is the last one, cut off, and is refused. Where several lie
    outside, the range is wrong.
    """
    margin = _ROUNDED * max(high - low, abs(low), abs(high))
    outside = (values < low - margin) | (values > high + margin)
    if not outside.any():
        return ()
    words = f"its header states heights from {low:g} to {high:g}"
    if outside[-1] and outside.sum() == 1:
        raise InputError(
            f"{path}: {words}, its last one is {values[-1]:g}: the file is cut off within this "
            "number, so export it again"
        )
    held = f"from {np.nanmin(values):g} to {np.nanmax(values):g}"
    return (f"{words}, the file holds heights {held}",)


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
