"""Confidence intervals: the t quantile, means, and the jackknife."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from .estimate import Estimate
from .limits import CONFIDENCE

#: Dimension of the parts that a jackknife leaves out one by one.
LEFT_OUT = "left_out"


def t_quantile(freedom: ArrayLike) -> Any:
    """Half the width of a 95 % interval in standard errors: Student's t for degrees of freedom."""
    # stdtrit is the quantile of scipy.stats.t, whose import alone costs most of a second.
    return special.stdtrit(freedom, (1 + CONFIDENCE) / 2)


def mean_interval(values: ArrayLike, axis: int = 0) -> Estimate:
    """Mean of independent values along an axis and its Student-t interval; NaN values are left out.

    NaN without a value; the interval needs two.
    """
    values = np.asarray(values, float)
    n = np.isfinite(values).sum(axis=axis)
    at_least_one, at_least_two = np.maximum(n, 1), np.maximum(n, 2)
    mean = np.where(n > 0, np.nansum(values, axis=axis) / at_least_one, np.nan)
    squares = np.nansum((values - np.expand_dims(mean, axis)) ** 2, axis=axis)
    error = np.sqrt(squares / (at_least_two - 1) / at_least_two)
    half = t_quantile(at_least_two - 1) * error
    half = np.where(n > 1, half, np.nan)
    return Estimate(mean, mean - half, mean + half, n)


def mean_difference(first: ArrayLike, second: ArrayLike) -> Estimate:
    """Mean of one sample (n,) less that of another (m,), with Student's interval for one variance.

    Without an interval where n + m is below three.
    """
    samples = [np.asarray(values, float) for values in (first, second)]
    difference = float(samples[0].mean() - samples[1].mean())
    freedom = sum(values.size - 1 for values in samples)
    if not freedom:
        return Estimate(difference, n=2)
    variance = sum(((values - values.mean()) ** 2).sum() for values in samples) / freedom
    half = t_quantile(freedom) * np.sqrt(variance * sum(1 / values.size for values in samples))
    return Estimate(difference, difference - half, difference + half, freedom + 2)


def jackknife_error(*divisions: ArrayLike) -> float:
    """Half the t-interval of a value by the jackknife, which leaves out one part after another.

    Parameters
    ----------
    *divisions : (n,) array_like
        Replicates: the value without each part of a division of the window, NaN where there is
        none. Where the window is divided in more than one way, their variances are averaged and
        their degrees of freedom added.

    Returns
    -------
    float
        A division in fewer than two parts does not count; 0 if there is no other, infinite where
        only one of its parts gives a value.
    """
    replicates = [np.asarray(values, float) for values in divisions]
    replicates = [values[np.isfinite(values)] for values in replicates if values.size > 1]
    if not replicates:
        return 0.0
    if min(values.size for values in replicates) < 2:
        return np.inf
    variance = np.mean([(values.size - 1) * np.var(values) for values in replicates])
    freedom = sum(values.size - 1 for values in replicates)
    return float(t_quantile(freedom) * np.sqrt(variance))
