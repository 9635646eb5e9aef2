"""Closed ranges, with a tolerance for rounding."""

from typing import Any

import numpy as np

#: Relative: spacings, box sizes and loads are products, whose last digits are chance.
RELATIVE_ROUNDING = 1e-9


def in_cells(lengths: tuple[float, float] | None, spacing: float) -> tuple[float, float]:
    """Range of lengths in cells; without one, all lengths.

    Parameters
    ----------
    lengths : (float, float) or None
        mm.
    spacing : float
        Of the cells, mm.
    """
    return (0.0, np.inf) if lengths is None else (lengths[0] / spacing, lengths[1] / spacing)


def within(values: Any, low: Any, high: Any) -> Any:
    """Mask of positive values in a range, ends included within rounding.

    Parameters
    ----------
    values : array_like or xr.DataArray
    low, high : float or xr.DataArray
        Positive, or 0 and infinity.

    Returns
    -------
    bool, of the kind and shape of the values
        False where a value is NaN.
    """
    values = values if hasattr(values, "dims") else np.asarray(values)
    return (values >= low * (1 - RELATIVE_ROUNDING)) & (values <= high * (1 + RELATIVE_ROUNDING))
