"""Numbers that mark missing cells without the file saying so: -9999, 1e20, zeros around the rim."""

from typing import NamedTuple

import numpy as np

from ..core.errors import InputError
from ..gridding.overhangs import is_closed

#: Least distance of a number far outside from the nearest of the others, in their quartile
#: distances: the extremes of any relief, level or tilted, lie within a few of each other.
_FAR = 10.0
#: Fewest cells that hold a number far outside which is a mark; a single one is a spike, unless it
#: is a usual mark.
_FEWEST = 3
_USUAL = (-9999.0, -99999.0, -999999.0, 9999.0, 99999.0, -999.0, -32768.0, -32767.0, 32767.0)
#: Fewest cells that hold a suspected number among the others, and how many times as many as hold
#: the next one: heights of instruments repeat, but none that much more.
_REPEATED, _DOMINANT = 30, 10.0
#: Most cells in which such numbers are looked for: a fixed draw, so that a large scan costs no more
#: than a small one.
_SAMPLE = 500_000
#: Fewest different heights of a scan; fewer are those of a synthetic surface of a few levels.
_MIN_LEVELS = 16
#: Neighbouring numbers, on either side, whose counts are compared with that of a number; and most
#: numbers examined.
_BESIDE, _MAX_LOOKED_AT = 5, 200
#: Largest number of whole numbers expected by chance where a whole number is a rarity.
_RARE = 0.3
#: Least distance of a number apart from the others, as a fraction of their range.
_APART = 0.2
#: Ends of grey levels and counts that instruments set.
_ENDS_OF_COUNTS = (0.0, 255.0, 65535.0, -32768.0, 32767.0)
#: Most marks that are looked for.
_MAX_MARKS = 4
#: Largest relative change of a mark by text and single precision.
_SAME = 1e-6


class Mark(NamedTuple):
    """A number that is likely to mark missing cells, in the file's own unit."""

    value: float
    cells: int
    """Cells that hold it."""
    outside: bool
    """True if it lies far outside the others; else it is among them and repeats."""
    low: float
    high: float
    """The others."""


def find_marks(heights: np.ndarray) -> list[Mark]:
    """Numbers that are likely to mark missing cells, those far outside the others first.

    Heights are a matrix or those of points (n,), in the file's unit; NaN where missing.
    """
    present = np.isfinite(heights)
    marks: list[Mark] = []
    while len(marks) < _MAX_MARKS and present.any():
        mark = _far_outside(heights, present)
        outside = mark is not None
        if mark is None:
            mark = _repeated(heights, present)
        if mark is None:
            break
        alike = present & np.isclose(heights, mark, rtol=_SAME, atol=0)
        present &= ~alike
        cells = int(alike.sum())
        if not present.any():
            break
        low, high = float(heights[present].min()), float(heights[present].max())
        marks.append(Mark(mark, cells, outside, low, high))
    return marks


def possible_marks(heights: np.ndarray) -> list[tuple[float, int]]:
    """Numbers that may mark missing cells or be heights, and their cells, the most frequent first.

    Those are 0, -1, the usual marks, and the lowest and highest number, where they occur more often
    than the numbers next to them; a whole number among many of more digits; any number that occurs
    several times as often as those next to it. Heights are in the file's unit; NaN where missing.
    """
    z = heights[np.isfinite(heights)]
    levels, counts = np.unique(z, return_counts=True)
    if levels.size < 3:
        return []
    is_whole = levels == np.round(levels)
    in_counts = 2 * int(counts[is_whole].sum()) > z.size
    # One in a hundred numbers of two decimals is whole by chance: no rarity.
    digits = next((d for d in range(7) if _has_digits(levels, d)), 7)
    is_rare = not in_counts and z.size * 10.0**-digits < _RARE
    usual = np.isin(levels, (0.0, -1.0, *_USUAL))
    ends = np.zeros(levels.size, bool)
    ends[[0, -1]] = True
    looked_at = np.flatnonzero(ends | usual | (counts >= _FEWEST) | (is_rare & is_whole))
    looked_at = looked_at[np.argsort(-counts[looked_at], kind="stable")][:_MAX_LOOKED_AT]
    # Numbers of few digits repeat by chance, many as often as the most frequent one.
    most = 2 * int(np.median(np.sort(counts)[-_MAX_LOOKED_AT // 10 :]))
    suspects = []
    for n in map(int, looked_at):
        neighbours = np.r_[counts[max(0, n - _BESIDE) : n], counts[n + 1 : n + 1 + _BESIDE]].max()
        is_special = ends[n] or usual[n]
        often = counts[n] > (max(neighbours, 1) if is_special else max(2 * neighbours, most))
        is_lone = is_rare and (is_special or counts[n] > 1)
        lone = is_whole[n] and (is_lone or (in_counts and _is_apart(levels, n)))
        of_counts = in_counts and ends[n] and levels[n] in _ENDS_OF_COUNTS
        if often or lone or of_counts or levels[n] in _USUAL:
            suspects.append((float(levels[n]), int(counts[n])))
    return suspects


def _has_digits(levels: np.ndarray, digits: int) -> bool:
    """True if nearly all numbers have this many decimals at most."""
    scaled = levels * 10.0**digits
    return bool(
        np.mean(np.abs(scaled - np.round(scaled)) < 1e-6 * np.maximum(1, abs(scaled))) > 0.9
    )


def _is_apart(levels: np.ndarray, n: int) -> bool:
    """True for the lowest or highest number, if it lies far from the next."""
    if n not in (0, levels.size - 1):
        return False
    others = np.delete(levels, n)
    return bool(np.abs(others - levels[n]).min() > _APART * np.ptp(others))


def refuse_or_warn(heights: np.ndarray, path: object, triangles: np.ndarray | None = None) -> str:
    """Refuse heights far outside the others; sentence on a number that repeats, "" for none.

    Of a mesh, such a number may be the flat bottom of a body; a closed one is left to gridding.
    """
    marks = find_marks(heights)
    if not marks and np.isin(heights, _USUAL).any():
        z = heights[np.isfinite(heights)]
        ends = float(z.min()), float(z.max())
        usual = [(value, cells) for value, cells in possible_marks(z) if value in _USUAL]
        marks = [Mark(value, cells, True, *ends) for value, cells in usual]
    if marks and triangles is not None and is_closed(triangles):
        return ""
    far = [mark for mark in marks if mark.outside]
    every = ", ".join(number(mark.value) for mark in marks)
    key = f"missing: {every}" if len(marks) == 1 else f"missing: [{every}]"
    remedy = f"write '{key}' into the sidecar, or 'missing: none' if these are heights"
    if far:
        parts = "; ".join(
            f"{mark.cells} x {number(mark.value)}, {_where(mark)} "
            f"({number(mark.low)} to {number(mark.high)})"
            for mark in far
        )
        mark = "a mark for missing cells"
        if triangles is not None:
            mark = f"the flat bottom of a body, whose face you should cut out, or {mark}"
        raise InputError(f"{path}: {parts}: probably {mark}; {remedy}")
    if marks:
        parts = " and ".join(f"{mark.cells} x exactly {number(mark.value)}" for mark in marks)
        return (
            f"{parts}, many times as often as any other height: probably cells without a "
            f"measurement, or heights cut off there; {remedy}"
        )
    return ""


def _where(mark: Mark) -> str:
    return (
        "a usual mark among others"
        if mark.low <= mark.value <= mark.high
        else "far outside all others"
    )


def number(value: float) -> str:
    """Number in plain digits: whole numbers whole, others to seven digits."""
    if value == round(value) and abs(value) < 1e15:
        return str(round(value))
    return f"{value:.7g}"


def _far_outside(heights: np.ndarray, present: np.ndarray) -> float | None:
    """The lowest or the highest number, if it is far from all others and repeats."""
    z = heights[present]
    for extreme, sign in ((float(z.min()), 1), (float(z.max()), -1)):
        alike = np.isclose(z, extreme, rtol=_SAME, atol=0)
        others = z[~alike]
        is_usual = extreme in _USUAL or abs(extreme) >= 1e19
        if others.size < _FEWEST or (alike.sum() < _FEWEST and not is_usual):
            continue
        gap = sign * (float(others.min() if sign > 0 else others.max()) - extreme)
        drawn = _drawn(others)
        low, high = np.percentile(drawn, [25, 75])
        # A second mark in a quarter of the cells widens the quartiles; it is found first.
        if high > low and gap > _FAR * (high - low) and np.unique(drawn).size >= _MIN_LEVELS:
            return extreme
    return None


def _repeated(heights: np.ndarray, present: np.ndarray) -> float | None:
    """A number that repeats many times as often as any other, or alone fills whole blocks."""
    drawn = _drawn(heights[present])
    value = _dominant(drawn)
    if value is None and heights.ndim == 2:
        value = _dominant(heights[_flat(heights) & present], fewest=_REPEATED // 3)
        if value is not None and np.unique(drawn).size < _MIN_LEVELS:
            return None
    return value


def _dominant(values: np.ndarray, fewest: int = _REPEATED) -> float | None:
    """Value that occurs far more often than the next; None without one."""
    if values.size == 0:
        return None
    levels, counts = np.unique(values, return_counts=True)
    first = int(np.argmax(counts))
    most = int(counts[first])
    next_most = int(np.delete(counts, first).max(initial=0))
    few_levels = fewest == _REPEATED and levels.size < _MIN_LEVELS
    return None if few_levels or most < max(fewest, _DOMINANT * next_most) else float(levels[first])


def _flat(heights: np.ndarray) -> np.ndarray:
    """Cells that are equal to all their eight neighbours."""
    flat = np.zeros(heights.shape, bool)
    if min(heights.shape) < 3:
        return flat
    along = heights[:, 1:] == heights[:, :-1]
    three = along[:, 1:] & along[:, :-1]
    down = (heights[1:] == heights[:-1])[:, 1:-1]
    flat[1:-1, 1:-1] = three[1:-1] & three[:-2] & three[2:] & down[1:] & down[:-1]
    return flat


def _drawn(values: np.ndarray) -> np.ndarray:
    """This many of the values, drawn once and for all."""
    if values.size <= _SAMPLE:
        return values
    return values[np.random.default_rng(0).integers(0, values.size, _SAMPLE)]
