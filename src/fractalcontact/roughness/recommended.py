"""The recommended surface dimension Delta_g: which of the estimates to use, and when none is to be.

Estimators that look at the same heights do not err independently, so that their mean is no better
than the best of them, and worse where a roll-off or the edges of the scan bend some of the curves.
"""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

#: The estimator whose value is the answer.
RECOMMENDED = "second_differences"
#: Why: figures of the experiment `estimator_bias`, `config/estimators.yaml`.
REASON = (
    "smallest rms error on synthetic surfaces of known dimension with a roll-off and without, its "
    "95 % interval holds the known value on 90 % of them or more, and a tilt of the surface does "
    "not touch it"
)

#: Dimensions a surface can have: a plane's, and that of what fills space.
POSSIBLE = (2.0, 3.0)


class Recommended(NamedTuple):
    """The estimate to use."""

    value: float
    low: float
    high: float
    """95 % interval; all three NaN where there is none to use."""
    no_dimension: str
    """Why there is none; "" where there is."""


def recommended(dimensions: xr.Dataset) -> Recommended:
    """Delta_g by the recommended estimator, if it can be a dimension.

    Parameters
    ----------
    dimensions : xr.Dataset
        ``dimension`` with its interval on ``estimator``.

    Returns
    -------
    Recommended
        Nothing where the estimator found no dimension, or one that is not between 2 and 3: what is
        smoother than a plane allows, or rougher than independent heights, is not self-affine over
        these lags, and no theory of self-affine surfaces applies.
    """
    if RECOMMENDED not in dimensions["estimator"].values:
        return Recommended(*(np.nan,) * 3, f"{RECOMMENDED.replace('_', ' ')} were not measured")
    chosen = dimensions.sel(estimator=RECOMMENDED)
    value, low, high = (float(chosen[f"dimension{end}"]) for end in ("", "_low", "_high"))
    if not np.isfinite(value):
        return Recommended(*(np.nan,) * 3, "no fit: too few lags or no relief")
    least, most = POSSIBLE
    if least < value < most:
        return Recommended(value, low, high, "")
    inside = low < most and high > least
    reason = f"Delta_g {value:.2f} [{low:.2f}, {high:.2f}] does not lie between 2 and 3" + (
        f" (its interval reaches {'above 2' if value <= least else 'below 3'})"
        if inside
        else ": not self-affine over the lags fitted"
    )
    return Recommended(*(np.nan,) * 3, reason)


def best_dimension(dimensions: xr.Dataset) -> tuple[float, float, float]:
    """Delta_g that calculations are to use.

    Parameters
    ----------
    dimensions : xr.Dataset
        From :func:`roughness.dimension.surface_dimension`.

    Returns
    -------
    value, low, high : float
        Estimate and 95 % interval, as :func:`recommended`; NaN where there is none to use.
    """
    return recommended(dimensions)[:3]


def dimension_table(dimensions: xr.Dataset) -> dict[str, float]:
    """Range and mean of Delta_g over the estimators, as the paper states them.

    Parameters
    ----------
    dimensions : xr.Dataset
        From :func:`roughness.dimension.surface_dimension`.

    Returns
    -------
    dict
        ``lowest``, ``highest``, ``mean`` (NaN without a fit) and ``n``, how many gave a dimension.
        The mean is no estimate: see :func:`recommended`.
    """
    known = dimensions["dimension"].values
    known = known[np.isfinite(known)]
    if not known.size:
        return dict.fromkeys(("lowest", "highest", "mean"), np.nan) | {"n": 0}
    return {
        "lowest": float(known.min()),
        "highest": float(known.max()),
        "mean": float(known.mean()),
        "n": known.size,
    }


def recommended_variables(dimensions: xr.Dataset) -> dict[str, Any]:
    """Variables of the recommended estimate, by the names of the atlas."""
    found = recommended(dimensions)
    return {
        "recommended": RECOMMENDED,
        "reason": REASON,
        "no_dimension": found.no_dimension,
        "recommended_value": found.value,
        "recommended_low": found.low,
        "recommended_high": found.high,
    }
