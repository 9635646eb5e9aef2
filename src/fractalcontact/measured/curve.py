"""Curves with errors, measured or computed, and their ratio."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from ..core.estimate import Estimate
from ..core.intervals import t_quantile

#: Fewest points of a curve, and fewest readings for an estimate of their scatter.
MIN_POINTS, MIN_READINGS = 2, 5
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Curve:
    """Values ``y`` (n,) over ascending ``x`` (n,), with the half-widths of their intervals.

    ``log_x`` says that the curve is interpolated over the logarithm of x, as curves over a pressure
    are.
    """

    x: np.ndarray
    y: np.ndarray
    error: np.ndarray
    log_x: bool = True

    @classmethod
    def of(cls, x: ArrayLike, y: ArrayLike, error: ArrayLike, *, log_x: bool = True) -> "Curve":
        """Curve of the points with a value; an unknown error counts as none."""
        x, y, error = (np.asarray(values, float) for values in np.broadcast_arrays(x, y, error))
        finite = np.isfinite(x) & np.isfinite(y) & ((x > 0) | (not log_x))
        order = np.argsort(x[finite], kind="stable")
        return cls(x[finite][order], y[finite][order], np.nan_to_num(error[finite][order]), log_x)

    def at(self, x: np.ndarray | float) -> Estimate:
        """Values between the points, NaN outside; the error is the larger error of the two
        neighbouring points.
        """
        x = np.asarray(x, float)
        if self.x.size < MIN_POINTS:
            nothing = np.full(x.shape, np.nan)
            return Estimate(nothing, nothing, nothing)
        places, (knots, first) = self._scale(x), np.unique(self._scale(self.x), return_index=True)
        for end in (knots[0], knots[-1]):  # equal pressures may differ by rounding
            places = np.where(np.isclose(places, end, rtol=0, atol=_ROUNDING), end, places)
        y = PchipInterpolator(knots, self.y[first], extrapolate=False)(places)
        index = np.clip(np.searchsorted(self.x, x), 1, self.x.size - 1)
        error = np.maximum(self.error[index - 1], self.error[index])
        return Estimate(y, y - error, y + error)

    def where(self, kept: np.ndarray) -> "Curve":
        """Curve at those of its points that are kept, (n,) bool."""
        return replace(self, x=self.x[kept], y=self.y[kept], error=self.error[kept])

    @property
    def values(self) -> Estimate:
        """Values at the points, with their intervals."""
        return Estimate(self.y, self.y - self.error, self.y + self.error)

    def since(self, x: float) -> "Curve":
        """The curve from a point on, its values counted from there; both ends are uncertain."""
        start = self.at(x)
        error = np.hypot(self.error, start.high - start.value)
        counted = replace(self, y=self.y - start.value, error=error)
        return counted.where(self.x >= x * (1 - _ROUNDING))

    def _scale(self, x: np.ndarray) -> np.ndarray:
        return np.log(x) if self.log_x else x


def scatter(x: np.ndarray, y: np.ndarray) -> float:
    """Half-width of the interval of one reading, from what neighbours leave unexplained.

    Each reading is compared with the straight line through those on both sides (Gasser, Sroka &
    Jennen-Steinmetz, Biometrika 73 (1986) 625). x (n,) ascends; equal ones are passed over.
    """
    left, right = x[1:-1] - x[:-2], x[2:] - x[1:-1]
    span = left + right
    apart = span > 0
    if y.size < MIN_READINGS or not apart.any():
        return 0.0
    left, right = left[apart] / span[apart], right[apart] / span[apart]
    residual = right * y[:-2][apart] + left * y[2:][apart] - y[1:-1][apart]
    variance = np.mean(residual**2 / (1 + left**2 + right**2))
    return float(t_quantile(apart.sum()) * np.sqrt(variance))


def ratio(first: Estimate, second: Estimate) -> Estimate:
    """Ratio of two positive quantities; the errors of their logarithms add up by squares."""
    with np.errstate(all="ignore"):
        value = np.where((first.value > 0) & (second.value > 0), first.value / second.value, np.nan)
        low, high = (
            np.hypot(np.log(a / first.value), np.log(b / second.value))
            for a, b in (
                (np.maximum(first.low, 0), second.high),
                (first.high, np.maximum(second.low, 0)),
            )
        )
        ends = value * np.exp(-low), np.where(np.isfinite(high), value * np.exp(high), np.inf)
    return Estimate(value, *ends)


def compared(computed: Curve, measured: Curve) -> dict[str, Any]:
    """Computed curve at its own points, the measured one there, and their ratio."""
    values, read = computed.values, measured.at(computed.x)
    return {"at": computed.x, "measured": read, "computed": values, "ratio": ratio(values, read)}
