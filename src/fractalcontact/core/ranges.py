"""Ranges whose ends belong to them, but for rounding."""

import numpy as np

#: Relative: spacings, box sizes and loads are products, whose last digits are chance.
ROUNDING = 1e-9


def within(values, low, high):
    """Which of some positive values lie in a range, its ends included whatever their last digits.

    Parameters
    ----------
    values : array_like or xr.DataArray
    low, high : float
        Positive, or 0 and infinity.

    Returns
    -------
    bool, of the kind and shape of the values
        False where a value is NaN.
    """
    values = values if hasattr(values, "dims") else np.asarray(values)
    return (values >= low * (1 - ROUNDING)) & (values <= high * (1 + ROUNDING))
