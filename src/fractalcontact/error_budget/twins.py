"""Spread over twins of a scan: the sampling error of its one window."""

import numpy as np
import xarray as xr

from .refinement import BUDGET_QUANTITIES, LoadCurve

#: Quantities of the budget in the ensemble and in the closure curves. Separations of faces that are
#: loaded equally differ by their mean gaps, but for what the window bulges.
_OF_ENSEMBLE = {
    "closure": "interface_closure",
    "separation": "mean_gap",
    "area_corrected": "area_corrected_share",
    "stiffness": "interface_stiffness",
    "delta_sigma": "delta_sigma",
}
#: Yielding contacts have one area, F/H, but for the solver.
_ROUNDING = 1e-3
INSIDE, OUTSIDE = "within their band", "outside their band"


def twins_spread(curve: LoadCurve, twins: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Half-widths within which one more twin lies at 95 %, and whether the scan does.

    Parameters
    ----------
    curve : LoadCurve
        Of the scan.
    twins : xr.Dataset
        Stage ``ensemble``, of its twins.

    Returns
    -------
    half : (quantity, normal_force) ndarray
        In the quantity's unit; NaN under loads that were not solved, or at which a twin has no
        value.
    within : (quantity, normal_force) ndarray of str
        :data:`INSIDE`, :data:`OUTSIDE`, or empty.
    """
    forces, count = twins["normal_force"].values, twins.sizes["realisation"]
    places = [int(np.argmin(np.abs(curve.forces - force))) for force in forces]
    half = np.full((len(BUDGET_QUANTITIES), len(curve.forces)), np.nan)
    within = np.full(half.shape, "", dtype=f"U{max(len(INSIDE), len(OUTSIDE))}")
    for row, quantity in enumerate(BUDGET_QUANTITIES):
        name = _OF_ENSEMBLE[quantity]
        every = twins[f"{name}_n"].values == count
        low, high = (
            np.where(every, twins[f"{name}_band_{end}"].values, np.nan) for end in ("low", "high")
        )
        size = curve.loading.area if quantity == "area_corrected" else 1.0
        half[row, places] = size * (high - low) / 2
        own = (curve.domains if quantity == "delta_sigma" else curve.curve)[name].values[places]
        edge = _ROUNDING * np.abs(own)
        said = np.where((low - edge <= own) & (own <= high + edge), INSIDE, OUTSIDE)
        within[row, places] = np.where(np.isfinite(own + low), said, "")
    return half, within
