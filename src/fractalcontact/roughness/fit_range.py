"""Range of lags over which the dimension of a surface is fitted: between grid and roll-off."""

from typing import NamedTuple

import numpy as np

from .estimators.second_differences import NOISE, second_difference_curves
from .known_bias import unresolved
from .roll_off import RollOff, find_roll_off

#: Default fit range in cells and in parts of the smaller side. Below 4 cells interpolation and
#: aliasing show; above an eighth of the side too few independent pairs or windows are left.
FIRST_CELLS, LAST_PART = 4, 1 / 8

#: Fraction of a roll-off at which the range ends: a lag sees waves of twice its length, so that the
#: longest waves fitted are half of the roll-off. Their missing part is taken off as known bias.
LAST_OF_ROLL_OFF = 1 / 4

#: First cell of a range that a roll-off cuts, if that is needed to span this ratio.
MIN_CELLS, MIN_RATIO = 2, 3.0


class FitRange(NamedTuple):
    """Range of lags of the fits of a dimension, and its reason."""

    shortest: float
    longest: float
    """Longest lag, mm; not above the shortest where no lag is left."""
    roll_off: RollOff
    """Roll-off of the spectrum, mm."""
    reason: str


def choose_fit_range(
    heights: np.ndarray, spacing: float, stated: tuple[float, float] | None = None
) -> FitRange:
    """Range of lags, mm, of a levelled surface (ny, nx), mm, NaN where missing.

    A stated range is used unchanged; the reason names a roll-off inside it. By default it goes from
    `FIRST_CELLS` cells to `LAST_PART` of the smaller side, or to `LAST_OF_ROLL_OFF` of a roll-off,
    and then from `MIN_CELLS` cells if need be. ValueError if the stated range does not rise from
    above 0.
    """
    if stated is not None and not 0 < stated[0] < stated[1]:
        raise ValueError(f"fit range {stated} mm must rise from above 0")
    curve = second_difference_curves(heights, spacing)["both"]
    roll_off = find_roll_off(curve, spacing, NOISE * unresolved())
    end = LAST_OF_ROLL_OFF * roll_off.value
    if stated is not None:
        reason = "stated by the study"
        if end < stated[1]:
            reason += f"; reaches beyond a quarter of the roll-off at {_words(roll_off)}"
        return FitRange(*stated, roll_off, reason)
    first, last = FIRST_CELLS * spacing, LAST_PART * min(heights.shape) * spacing
    if not end < last:
        return FitRange(first, last, roll_off, "4 cells to an eighth of the smaller side")
    first = min(first, max(end / MIN_RATIO, MIN_CELLS * spacing))
    reason = f"up to a quarter of the roll-off at {_words(roll_off)}"
    return FitRange(first, end, roll_off, reason)


def _words(roll_off: RollOff) -> str:
    value, low, high = roll_off.ends
    return f"{value:.3g} mm [{low:.3g}, {high:.3g}] ({roll_off.shape})"
