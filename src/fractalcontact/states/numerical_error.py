"""Numerical error of a contact state: its values on finer grids, extrapolated to zero spacing.

The constants are calibrated on synthetic joints whose truth is known, by
``benchmarks/error_coverage.py``, which also says how many of other joints the errors cover.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

#: Smallest and largest credible order of convergence.
MIN_ORDER, MAX_ORDER = 0.5, 3.0

#: Fraction of the extrapolation, or of the last change, that is uncertain.
UNCERTAIN_FRACTION = 0.5

#: Error that may not show in the changes between spacings, as fractions of the quantity's edge
#: part: with three spacings and with two.
OF_EDGE = {
    "closure": (0.025, 0.01),
    "separation": (0.005, 0.05),
    "area_corrected": (0.03, 0.1),
    "stiffness": (0.015, 0.08),
}
_NONE = (0.0, 0.0)


class NumericalError(NamedTuple):
    """Numerical errors at the spacing s, in the unit and shape (...) of the values."""

    error: np.ndarray
    """Half-width of an interval of about 95 %."""
    limit: np.ndarray
    """Value at zero spacing, NaN where it is not extrapolated."""
    order: np.ndarray
    """Observed order, within its bounds; NaN where the changes are not monotone or too few."""


class _Extrapolated(NamedTuple):
    """The change from s to the best known value, and how uncertain that value is."""

    change: np.ndarray
    uncertain: np.ndarray
    largest: np.ndarray
    order: np.ndarray


def _extrapolated(values: ArrayLike) -> _Extrapolated:
    """Richardson's extrapolation where the changes allow one, else the finest value."""
    coarse, middle, fine = np.asarray(values, float)
    first, second = coarse - middle, middle - fine
    three = np.isfinite(fine)
    with np.errstate(all="ignore"):
        ratio = first / second
        monotone = three & (ratio > 1)
        order = np.clip(np.log2(np.where(monotone, ratio, 2.0)), MIN_ORDER, MAX_ORDER)
    beyond = np.where(monotone, second / (2.0**order - 1), 0.0)
    last = np.where(three, second, first)
    change = np.where(three, first + second + beyond, first)
    return _Extrapolated(
        change,
        UNCERTAIN_FRACTION * np.abs(np.where(monotone, beyond, last)),
        np.where(monotone, np.abs(change), np.fmax.reduce(np.abs([first, last, change]))),
        np.where(monotone, order, np.nan),
    )


def numerical_error(quantity: str, values: ArrayLike, edge: ArrayLike = 0.0) -> NumericalError:
    """Numerical error of values (3, ...) at the spacing s, from those at s, s/2 and s/4.

    Values at s/4 are NaN where that was not solved. ``quantity`` is their name: those in
    :data:`OF_EDGE` have rules of their own. ``edge`` (...) is the part of the values that depends
    on the cells at the edge of contact.

    Where the changes from s to s/2 and from s/2 to s/4 have one sign and the second is smaller,
    their ratio gives the order, and Richardson's extrapolation the limit: the error is the distance
    from it and a fraction of the extrapolation. Else nothing is extrapolated, and the error is the
    largest of the changes and a fraction of the last, as with two spacings (P. J. Roache, J. Fluids
    Eng. 116 (1994) 405, on safety factors where the order is only believed).

    Contact changes by whole nodes, so that a change may be small by chance. By how much, the edge
    shows: (A_r - A)/A_r, raw and corrected area, is the fraction of the contact that its cells at
    the edge overstate. That fraction of the area, of the stiffness, and of the length sigma_0/(d
    sigma/d w_int) of separations and closures is their ``edge``, of which a few per cent are added.
    """
    extrapolated, fine = _extrapolated(values), np.isfinite(np.asarray(values, float)[2])
    error = extrapolated.largest + extrapolated.uncertain + _of_edge(quantity, edge, fine)
    limit = np.asarray(values, float)[0] - extrapolated.change
    return NumericalError(
        error, np.where(np.isfinite(extrapolated.order), limit, np.nan), extrapolated.order
    )


def closure_numerical_error(
    closures: ArrayLike, separations: ArrayLike, edge: ArrayLike, rise: ArrayLike
) -> NumericalError:
    """Numerical error of closures (...) from first contact, mm, whose summit is known.

    ``separations`` (3, ...) are those of the mean planes at s, s/2 and s/4, ``edge`` is that of
    :func:`numerical_error`, and the summit of the surface is above the highest node at s by
    ``rise``, all in mm. Closure is the summit less the separation and less the bulk settlement. The
    summit of the spline is found without any solve: what is extrapolated is the separation alone.
    """
    extrapolated, fine = _extrapolated(separations), np.isfinite(np.asarray(separations, float)[2])
    gain = np.asarray(rise) + extrapolated.change
    error = np.abs(gain) + extrapolated.uncertain + _of_edge("closure", edge, fine)
    limit = np.where(np.isfinite(extrapolated.order), closures + gain, np.nan)
    return NumericalError(error, limit, extrapolated.order)


def _of_edge(quantity: str, edge: ArrayLike, fine: np.ndarray) -> np.ndarray:
    three, two = OF_EDGE.get(quantity, _NONE)
    return np.where(fine, three, two) * np.abs(edge)
