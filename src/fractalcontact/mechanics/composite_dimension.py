"""Surface dimension of the composite topography (Fig. 3), from lags below the offset alone."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.estimate import names_of
from ..core.labels import cf_attrs
from ..roughness.dimension import measured_exponents, surface_dimension
from ..roughness.fit_range import FitRange, below_offset
from .lag_dimension import lag_dimensions

#: How Delta_g of the composite topographies is measured: of the estimators with little bias the
#: one that a tilt of the composite, which is part of the joint, does not touch.
COMPOSITE_ESTIMATOR = "second_differences"


def composite_dimensions(
    specimen: xr.Dataset,
    composites: Sequence[np.ndarray],
    offsets: np.ndarray,
    stated: tuple[float, float] | None,
) -> dict[str, tuple]:
    """Delta_g of composite topographies against the offset, with intervals and lengths fitted.

    Parameters
    ----------
    specimen : xr.Dataset
    composites : sequence of (ny, nx) ndarray
        Heights by offset, mm.
    offsets : (n,) ndarray
        mm.
    stated : (float, float) or None
        Range of lags the study states, mm.

    Returns
    -------
    dict of str to (dims, values, attributes)
        ``composite_dimension`` with ``_low`` and ``_high``, ``composite_fit_min`` and ``_max`` (mm)
        and ``composite_no_dimension``, why there is none, all (offset), and those of
        :func:`mechanics.lag_dimension.lag_dimensions`, over lags that are the same at all offsets.

    Notes
    -----
    Where the faces match, the composite topography is the difference of a surface and itself. Its
    mean square second difference is twice that of the face at lags well below the offset, and
    flattens above: a fit across says how flat it is, not what dimension it has. Lags go up to half
    of the offset, or to where the face's own range ends.
    """
    spacing = tuple(specimen.attrs[f"spacing_{axis}"] for axis in "yx")
    matches = specimen.attrs["opposite"] == "match"
    _, face = measured_exponents(specimen["lower"].values, spacing, fit_range=stated, estimators=[])
    fits = [
        below_offset(face, offset, max(spacing)) if matches else (stated, "") for offset in offsets
    ]
    each = [
        _composite_dimension(composite, spacing, *fit)
        for composite, fit in zip(composites, fits, strict=True)
    ]
    names = [*names_of("dimension"), "fit_min", "fit_max", "no_dimension"]
    dimensions = xr.concat([one[names] for one in each], "offset")
    return {
        f"composite_{name}": ("offset", dimensions[name].values, dimensions[name].attrs)
        for name in names
    } | lag_dimensions(composites, spacing, face.longest)


def _composite_dimension(
    composite: np.ndarray,
    spacing: tuple[float, ...],
    fit_range: FitRange | tuple[float, float] | None,
    refusal: str,
) -> xr.Dataset:
    """Dimension of one composite topography; NaN with the reason if it has none."""
    measured = surface_dimension(
        composite,
        (spacing[0], spacing[1]),
        fit_range=fit_range,
        estimators=[] if refusal else [COMPOSITE_ESTIMATOR],
    )
    result = measured.reindex(estimator=[COMPOSITE_ESTIMATOR]).squeeze("estimator")
    if not refusal and np.isnan(result["dimension"]):
        refusal = "no fit: too few lags or no relief"
    attrs = cf_attrs("1", "why the composite topography has no dimension")
    return result.assign(no_dimension=((), refusal, attrs))
