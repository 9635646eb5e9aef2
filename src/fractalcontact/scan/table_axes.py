"""Coordinates or numbers of rows and columns that stand in the first row and column of a matrix."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.errors import InputError
from .raw import SMALLEST_SIDE

#: Coordinates may stray this fraction of a step from equal steps: rounding in the export.
EVEN = 0.1
#: A plane's rows rise evenly too. Beside coordinates fewer than this fraction of the others do.
FEW = 0.2
#: How many times more than rows usually do the first one differs from the plane through the next.
OUTLYING = 10
#: The same for a jump to a neighbour, which coordinates in uneven steps have.
JUMP = 3
#: Rows numbered with gaps reach up to this many times their count.
MOST_GAPS = 4
_SAMPLE = 64  # rows that the first one is compared with
_RULER = 5  # fewer numbers rise evenly by chance
_KEEP = "if they are heights too, write 'axes: none' into its sidecar"


@dataclass(frozen=True)
class Ruler:
    """Numbers in equal steps along one side of a matrix.

    Attributes
    ----------
    first, last : float
    count : int
    """

    first: float
    last: float
    count: int

    @property
    def step(self) -> float:
        """Signed step."""
        return float(f"{(self.last - self.first) / (self.count - 1):.10g}")

    @property
    def is_index(self) -> bool:
        """Whether they only count, from 0 or 1, up or down."""
        return abs(self.step) == 1 and min(self.first, self.last) in (0, 1)

    def __str__(self) -> str:
        what = "numbers" if self.is_index else "coordinates"
        return f"{what} from {self.first:.6g} to {self.last:.6g}"


def ruler(numbers: np.ndarray) -> Ruler | None:
    """Numbers in equal steps, or None."""
    if len(numbers) < _RULER or not np.isfinite(numbers).all():
        return None
    steps = np.linspace(numbers[0], numbers[-1], len(numbers))
    step = abs(numbers[-1] - numbers[0]) / (len(numbers) - 1)
    if not step > 0 or np.abs(numbers - steps).max() > EVEN * step:
        return None
    return Ruler(float(numbers[0]), float(numbers[-1]), len(numbers))


def without_axes(
    table: np.ndarray, where: str, header_x: np.ndarray | None = None
) -> tuple[np.ndarray, dict[str, Any]]:
    """Take coordinates, or numbers of rows and columns, off a matrix.

    Parameters
    ----------
    table : ndarray, shape (rows, columns)
    where : str
        The file, for errors.
    header_x : ndarray or None
        Numbers of the last header line, one for each column of heights, or one less than the table
        has columns.

    Returns
    -------
    heights : ndarray
        x ascending.
    stated : dict
        ``spacing``, ``first_row`` and ``notes`` for `RawScan`.

    Raises
    ------
    InputError
        If the first row or column rises as coordinates do, but in uneven steps, or tables with
        rows numbered anew stand one under the other.
    """
    if header_x is None:
        along_x, along_y = _both_edges(table, where)
        rows = table[1:] if along_x else table
    else:
        along_y = _edge(table, where, "first column")
        if along_y is None and header_x.size < table.shape[1]:
            raise _uneven(where, "first column")
        header_x = header_x[-(table.shape[1] - bool(along_y)) :]
        rows, along_x = table, ruler(header_x)
        if along_x is None and _is_monotone(header_x):
            raise _uneven(where, "first row")
    refuse_begun_anew(rows, None, where)
    heights = rows[:, 1:] if along_y else rows
    _refuse_axes_behind(heights, where)
    if along_x and along_x.step < 0:
        heights = heights[:, ::-1]
    return heights, _stated(along_x, along_y)


def _refuse_axes_behind(heights: np.ndarray, where: str) -> None:
    """Refuse coordinates in the last row or column, where no program is known to write them."""
    for name, turned in (("column", heights[:, ::-1]), ("row", heights[::-1].T)):
        if _edge(turned, where, f"last {name}"):
            raise InputError(
                f"{where}: its last {name} runs in equal steps as coordinates do; export x, y, z "
                f"as three columns, or the heights alone; {_KEEP}"
            )


def _both_edges(table: np.ndarray, where: str) -> tuple[Ruler | None, Ruler | None]:
    """Rulers in the first row and column; one alone takes in the corner between them."""
    along_y = _edge(table[1:], where, "first column")
    along_x = _edge(table[:, 1:].T, where, "first row")
    if along_x:
        refuse_begun_anew(table[1:], along_x, where)
    if along_y and not along_x:
        along_y = ruler(table[:, 0])
        if along_y is None:
            raise _uneven(where, "first row")
    elif along_x and not along_y:
        along_x = ruler(table[0])
        if along_x is None:
            raise _uneven(where, "first column")
    elif not (along_x or along_y) and _is_alone(table[1:]) and _is_alone(table[:, 1:].T):
        raise _uneven(where, "first column")
    return along_x, along_y


def _stated(along_x: Ruler | None, along_y: Ruler | None) -> dict[str, Any]:
    """What the rulers say of the heights between them."""
    stated: dict[str, Any] = {}
    notes = []
    for name, found in (("columns", along_x), ("rows", along_y)):
        if found:
            notes.append(f"{found} of its {name} are taken as such, not as heights")
    if along_y and not (along_y.is_index and along_y.step > 0):
        stated["first_row"] = "top" if along_y.step < 0 else "bottom"
    if along_x and along_y and not (along_x.is_index or along_y.is_index):
        stated["spacing"] = abs(along_x.step), abs(along_y.step)
    if notes:
        stated["notes"] = tuple(notes)
    return stated


def _edge(table: np.ndarray, where: str, name: str) -> Ruler | None:
    """The ruler that the first column of a table is, None if it holds heights.

    Raises
    ------
    InputError
        If it rises without a break, as coordinates do, but not in equal steps.
    """
    if min(table.shape) < 3:
        return None
    first = table[:, 0]
    others = table[:, 1 : 1 + _SAMPLE].T
    if found := ruler(first):
        even = np.mean([ruler(other) is not None for other in others])
        return found if even < FEW or _is_outlying(table) else None
    if not _is_alone(table):
        return None
    whole = bool(np.all(first == np.round(first))) and np.ptp(first) <= MOST_GAPS * len(first)
    if whole or _is_mostly_even(first) or _jumps(table):
        raise _uneven(where, name)
    return None


def _is_alone(table: np.ndarray) -> bool:
    """Whether the first column rises or falls throughout and few others do.

    One number all along a column is a mark for missing cells rather than heights: among such alone
    any column of a tilted face would seem to be one of coordinates.
    """
    if len(table) < SMALLEST_SIDE or not _is_monotone(table[:, 0]):
        return False
    others = list(table[:, 1 : 1 + _SAMPLE].T)
    others = [other for other in others if np.ptp(other) > 0] or others
    return bool(np.mean([_is_monotone(other) for other in others]) < FEW)


def _is_mostly_even(numbers: np.ndarray) -> bool:
    """Whether most steps are the same: coordinates with gaps."""
    steps = np.diff(numbers)
    middle = np.median(steps)
    return bool(np.mean(np.abs(steps - middle) <= EVEN * abs(middle)) > 0.5)


def _uneven(where: str, name: str) -> InputError:
    other = "row" if name.endswith("column") else "column"
    return InputError(
        f"{where}: its {name} rises as coordinates do, but in uneven steps or without a "
        f"{other} of them beside it; export x, y, z as three columns, or the heights alone; {_KEEP}"
    )


def _is_monotone(numbers: np.ndarray) -> bool:
    steps = np.diff(numbers)
    return bool(np.all(steps > 0) or np.all(steps < 0))


def _is_outlying(table: np.ndarray) -> bool:
    """Whether the first column lies off the plane of the next two, as no further column does."""
    columns = table[:, : _SAMPLE + 1]
    bends = columns[:, :-2] - 2 * columns[:, 1:-1] + columns[:, 2:]
    sizes = np.sqrt(np.nanmean(bends**2, axis=0))
    return bool(sizes[0] > OUTLYING * max(np.nanmax(sizes[1:]), 1e-12 * np.nanmax(np.abs(columns))))


def _jumps(table: np.ndarray) -> bool:
    """Whether the first column differs from the next far more than columns do from each other."""
    jumps = np.nanmedian(np.abs(np.diff(table[:, : _SAMPLE + 1], axis=1)), axis=0)
    return bool(jumps[0] > JUMP * np.nanmedian(jumps[1:]))


def refuse_begun_anew(rows: np.ndarray, along_x: Ruler | None, where: str) -> None:
    """Refuse tables under one another: their coordinates, above or at the side, begin anew.

    Parameters
    ----------
    rows : ndarray
        The table below its first row of coordinates, where it has one.
    along_x : Ruler or None
        That row.
    where : str

    Raises
    ------
    InputError
    """
    if along_x:
        above = np.linspace(along_x.first, along_x.last, along_x.count)
        close = np.abs(rows[:, -along_x.count :] - above) <= EVEN * abs(along_x.step)
        again = np.flatnonzero(close.all(axis=1))
        if len(again):
            raise stacked(where, len(again) + 1, int(again[0]))
    starts = np.flatnonzero(rows[:, 0] == rows[0, 0])
    if len(starts) < 2 or starts[1] < _RULER or len(rows) % starts[1]:
        return
    blocks = rows[:, 0].reshape(-1, int(starts[1]))
    if ruler(blocks[0]) and np.array_equal(blocks, np.broadcast_to(blocks[0], blocks.shape)):
        raise stacked(where, *blocks.shape)


def stacked(where: str, count: int, rows: int) -> InputError:
    """The error of several tables in one file."""
    return InputError(
        f"{where}: {count} tables of {rows} rows stand one under the other; write each into a file "
        "of its own, two faces as NAME.lower and NAME.upper; if it is one surface with a step, "
        "write 'axes: none' into the sidecar"
    )
