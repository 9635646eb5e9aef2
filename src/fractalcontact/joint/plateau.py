"""Plateau of the rigid dilatancy: its line over the second half of the offsets (Figs. 6 and 7)."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..core.directions import NO_SLIDING
from ..core.estimate import Estimate, rows_of
from ..core.fitting import MIN_POINTS, LineFit, fit_line
from ..core.labels import cf_attrs
from ..core.limits import LEVEL_CHANGE
from ..core.per_curve import stacked
from ..core.text import length_words
from ..core.verdicts import FALLING, LEVEL, RISING

_HALF = "rigid dilatancy over the second half of the offsets"
#: Quantities of every direction: unit and long name. Intervals take the offsets as independent.
_WORDS = {
    "plateau_level": ("mm", f"mean {_HALF}"),
    "plateau_slope": ("1", f"slope of the {_HALF}"),
    "plateau_change": ("1", f"change of the {_HALF}, a fraction of its mean"),
    "plateau_intercept": ("mm", f"line through the {_HALF}, at no offset"),
    "plateau_offset_min": ("mm", "smallest offset of that line"),
    "plateau_offset_max": ("mm", "largest offset of that line"),
    "plateau_trend": ("1", f"trend of the {_HALF}: {LEVEL}, {RISING} or {FALLING}"),
    "no_plateau": ("1", "why it has no line"),
}
#: Reason why a trend is not conclusive about a plateau: dimensions, unit, long name.
_UNDECIDED = {
    "plateau_undecided": ("direction", "1", f"why there is no verdict on a plateau of the {_HALF}")
}
#: Opposite directions, by the axis that they lie on.
AXES = {"E-W": ("E", "W"), "N-S": ("N", "S")}
_EVEN = "half the sum of the rigid dilatancies in opposite directions, the part of the roughness"
_ODD = "half their difference: a tilt of the window, and chance of the highest points"
_PART_DIMS = ("axis", "rigid_offset")
#: Parts of the rigid dilatancy over opposite directions: dimensions, unit, long name.
_PARTS = {
    "even_dilatancy": (_PART_DIMS, "mm", _EVEN),
    "odd_dilatancy": (_PART_DIMS, "mm", _ODD),
    **{
        name: ("axis", *words)
        for name, words in (
            rows_of("even_change", "1", f"change of its line, a fraction of its mean: {_EVEN}")
            | rows_of("odd_slope", "1", f"slope over the second half of the offsets: {_ODD}")
        ).items()
    },
}


def second_half(offset: np.ndarray) -> np.ndarray:
    """Offsets (n,) of the second half of the slide, where a plateau is looked for: a mask."""
    return offset >= offset[-1] / 2


def relative_change(slope: Any, offset: np.ndarray, mean: Any) -> Any:
    """Change of a line over offsets as a fraction of its mean; positive where it rises.

    NaN where the mean is zero.
    """
    size = np.where(np.asarray(mean) == 0, np.nan, np.abs(mean))
    return slope * np.ptp(offset) / size


def rigid_plateaus(
    offset: np.ndarray, opened: ArrayLike, directions: Sequence[str]
) -> dict[str, tuple]:
    """Level, slope and trend of the rigid dilatancy over the second half of the offsets.

    Offsets v (n,) and openings delta_r (directions, n) are in mm. Without a line all are missing
    but the reason ``no_plateau``. A change of up to a tenth of the mean is called level. The
    intervals are those of one least-squares line whose points count as independent; neighbouring
    offsets are not.
    """
    half = second_half(offset)
    v, opened = offset[half], np.asarray(opened, float)[:, half]
    rows = [
        _plateau(fit_line(v, row), row.mean(), v, direction)
        for row, direction in zip(opened, directions, strict=True)
    ]
    return stacked(rows, _WORDS, ["direction"])


def undecided_plateaus(
    offset: np.ndarray, correlation: np.ndarray, uncorrelated: np.ndarray
) -> dict[str, tuple]:
    """Reason why trends over the second half of the offsets say nothing of a plateau, by direction.

    Faces that match open as long as they still correlate: a plateau begins beyond (the spread of
    the composite topography is then that of two unrelated faces). ``correlation`` (directions, n)
    is that of the faces over the offsets, mm, ``uncorrelated`` the first offset where it does not
    differ from zero, NaN where there is none. Empty where the second half lies beyond that offset,
    or nothing slides.
    """
    first = offset[second_half(offset)][0]

    def reason(last: float, lost: float) -> str:
        if np.isnan(last) or lost <= first:
            return ""
        if np.isnan(lost):
            end = length_words(offset[-1])
            return f"offsets end at {end}, where the faces still correlate ({last:.2f})"
        return f"the faces still correlate up to {length_words(lost)}"

    words = [reason(*curve) for curve in zip(correlation[:, -1], uncorrelated, strict=True)]
    return labelled(_UNDECIDED, {"plateau_undecided": np.array(words)})


def opposite_parts(
    offset: np.ndarray, opened: ArrayLike, directions: Sequence[str]
) -> dict[str, tuple]:
    """Even and odd part of the rigid dilatancy over opposite directions, mm, by axis.

    A tilt a of the window against the plane that was removed from the face adds a v in one
    direction and - a v in the opposite one, so that the even part is of the roughness alone. The
    odd part is no measure of the tilt: the highest points differ by chance too. Intervals are those
    of the line through the second half of the offsets.
    """
    by_direction = dict(zip(directions, np.asarray(opened, float), strict=True))
    pairs = {axis: pair for axis, pair in AXES.items() if set(pair) <= by_direction.keys()}
    even, odd = (
        np.reshape(
            [(by_direction[a] + sign * by_direction[b]) / 2 for a, b in pairs.values()],
            (-1, offset.size),
        )
        for sign in (1, -1)
    )
    half = second_half(offset)
    v = offset[half]
    rows = [_plateau(fit_line(v, row), row.mean(), v, "none") for row in even[:, half]]
    changes = Estimate.stack(row["plateau_change"] for row in rows)
    slopes = Estimate.stack(fit_line(v, row).slope for row in odd[:, half])
    values = {"even_dilatancy": even, "odd_dilatancy": odd}
    values |= changes.columns("even_change") | slopes.columns("odd_slope")
    axis = ("axis", np.array(list(pairs), "U3"), cf_attrs("1", "axis of two opposite directions"))
    return labelled(_PARTS, values) | {"axis": axis}


def _plateau(line: LineFit, mean: float, v: np.ndarray, direction: str) -> dict[str, Any]:
    """Values of one direction."""
    slope, first_and_last = line.slope, line.slope.over
    change = slope.mapped(lambda rise: float(relative_change(rise, v, mean)))
    return {
        "plateau_level": mean if slope.known else np.nan,
        "plateau_slope": slope,
        "plateau_change": change,
        "plateau_intercept": line.intercept.value,
        "plateau_offset_min": first_and_last[0],
        "plateau_offset_max": first_and_last[1],
        "plateau_trend": _trend(change.value, slope.value),
        "no_plateau": "" if slope.known else _reason(line.n, direction),
    }


def _trend(change: float, slope: float) -> str:
    """Trend of a line; empty without one."""
    if not np.isfinite(slope):
        return ""
    if slope == 0 or abs(change) <= LEVEL_CHANGE:
        return LEVEL
    return RISING if slope > 0 else FALLING


def _reason(n: int, direction: str) -> str:
    if direction == "none":
        return f"{NO_SLIDING} does not slide"
    return f"{n} offsets in the second half, {MIN_POINTS} needed"
