"""Recommended surface dimension Delta_g: the choice among the estimates, or of none.

Estimators of the same heights do not err independently, so that their mean is no better
than the best of them, and worse where a roll-off or the edges of the scan bend some of the curves.
"""

from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.estimate import Estimate
from ..core.labels import cf_attrs
from .fit_range import LAST_OF_ROLL_OFF

#: The estimator whose value is the answer.
RECOMMENDED = "roughness_length"
#: An estimator that rests on other properties of the heights than sigma_z of windows.
INDEPENDENT = "power_spectrum"
#: Reason of the choice: on 50 surfaces of each kind in `config/estimators.yaml`, H from 0.5 to 0.9,
#: its rms error is 0.038 at 256 nodes per side (second differences 0.040, variogram 0.042, spectrum
#: 0.052), and half its interval 0.12 (0.13, 0.22, 0.14).
REASON = (
    "least rms error and narrowest 95 % interval of all estimators on synthetic surfaces of known "
    "dimension, with and without a roll-off; the interval contains the known value on more than "
    "90 % of every kind"
)

#: Dimensions a surface can have: a plane's, and that of what fills space.
POSSIBLE = (2.0, 3.0)


def best_dimension(dimensions: xr.Dataset) -> Estimate:
    """Delta_g by the recommended estimator, if it can be a dimension.

    Parameters
    ----------
    dimensions : xr.Dataset
        ``dimension`` with its interval on ``estimator``.

    Returns
    -------
    Estimate
        None, with the reason, where the estimator has no dimension, or one that is not between 2
        and 3: a surface smoother than a plane allows, or rougher than independent heights, is not
        self-affine over these lags, and no theory of self-affine surfaces applies.
    """
    if RECOMMENDED not in dimensions["estimator"].values:
        return Estimate(reason=f"{RECOMMENDED.replace('_', ' ')} was not measured")
    chosen = dimensions.sel(estimator=RECOMMENDED)
    dimension = Estimate.read(chosen, "dimension")
    value, low, high = dimension.ends
    if not dimension.known:
        return Estimate(reason="no fit: too few lags or no relief")
    least, most = POSSIBLE
    if least < value < most:
        return dimension
    inside = low < most and high > least
    reason = f"Delta_g {value:.2f} [{low:.2f}, {high:.2f}] does not lie between 2 and 3" + (
        f" (its interval reaches {'above 2' if value <= least else 'below 3'})"
        if inside
        else ": not self-affine over the lags fitted"
    )
    return Estimate(reason=reason)


def exponent_of_roughness(dimensions: xr.Dataset) -> Estimate:
    """Exponent H of sigma_z ~ b^H: the one that roughness-length windows have."""
    if RECOMMENDED not in dimensions["estimator"].values:
        return Estimate()
    return Estimate.read(dimensions.sel(estimator=RECOMMENDED), "hurst")


def independent_dimension(dimensions: xr.Dataset) -> Estimate:
    """Delta_g that does not come from sigma_z ~ b^H: the known one, or that of the spectrum."""
    known = float(dimensions["known_dimension"])
    if np.isfinite(known):
        return Estimate(known, known, known)
    if INDEPENDENT not in dimensions["estimator"].values:
        return Estimate()
    return Estimate.read(dimensions.sel(estimator=INDEPENDENT), "dimension")


#: Variables of all estimators together: long names.
_OF_ALL = {
    "dimensions_fitted": "estimators that found a dimension",
    "lowest_dimension": "lowest Delta_g of the estimators",
    "highest_dimension": "highest Delta_g of the estimators",
    "axes_compared": "estimators with a Hurst exponent along x and along y",
    "axes_differing": "estimators whose intervals of the Hurst exponent along x and y lie apart",
}


def variables_of_all(dimensions: xr.Dataset) -> dict[str, Any]:
    """Range of Delta_g over the estimators, as the paper states it, and how many separate x and y.

    Variables by the names of the atlas, from ``dimension``, ``hurst_x`` and ``hurst_y`` on
    ``estimator``; the range is NaN without a fit. The middle of the range is no estimate: see
    :func:`best_dimension`.
    """
    values_of_fits = dimensions["dimension"].values
    values_of_fits = values_of_fits[np.isfinite(values_of_fits)]
    x, y = (Estimate.read(dimensions, f"hurst_{axis}") for axis in "xy")
    compared = x.known & y.known
    differing = compared & ((x.low > y.high) | (y.low > x.high))
    values = {
        "dimensions_fitted": values_of_fits.size,
        "lowest_dimension": min(values_of_fits, default=np.nan),
        "highest_dimension": max(values_of_fits, default=np.nan),
        "axes_compared": np.sum(compared),
        "axes_differing": np.sum(differing),
    }
    return labelled({name: ((), "1", words) for name, words in _OF_ALL.items()}, values)


def beyond_roll_off(dimensions: xr.Dataset) -> bool:
    """True if lags were fitted beyond the part of a roll-off up to which its effect is known."""
    end = LAST_OF_ROLL_OFF * float(dimensions["roll_off"])
    return float(dimensions["range_max"]) > end * (1 + 1e-9)


def dimension_words(dimensions: xr.Dataset) -> str:
    """Sentence on the recommended estimate with the reason for its lags, or for having none."""
    reason = str(dimensions["no_dimension"].item())
    if reason:
        return f"no surface dimension: {reason}"
    value, low, high = Estimate.read(dimensions, "recommended_dimension").ends
    first, last = (float(dimensions[f"range_{end}"]) for end in ("min", "max"))
    return (
        f"Delta_g {value:.2f} [{low:.2f}, {high:.2f}] by {RECOMMENDED.replace('_', ' ')}, lags "
        f"{first:.3g} to {last:.3g} mm: {dimensions['range_reason'].item()}"
    )


def recommended_variables(dimensions: xr.Dataset) -> dict[str, Any]:
    """Variables of the recommended estimate, by the names of the atlas."""
    dimension = best_dimension(dimensions)
    words = {
        "recommended": (RECOMMENDED, "recommended estimator"),
        "reason": (REASON, "why this estimator"),
        "no_dimension": (dimension.reason, "why there is no recommended dimension"),
    }
    texts = {name: ((), text, cf_attrs("1", of)) for name, (text, of) in words.items()}
    return texts | dimension.variables("recommended_dimension", (), "1", "recommended Delta_g")
