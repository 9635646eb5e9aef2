"""Spread over twins of a scan, or realisations of a specimen: sampling error of one window."""

import numpy as np
import xarray as xr

from ..domain.random_nodes import band_of
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
#: Relative difference of areas by the solver alone: yielding contacts all have the area F/H.
_ROUNDING = 1e-3
INSIDE, OUTSIDE = "within their band", "outside their band"


def ensemble_spread(curve: LoadCurve, ensemble: xr.Dataset) -> np.ndarray:
    """Half-widths within which one more member of an ensemble lies at 95 %.

    (quantity, normal_force), in the quantity's unit; NaN under loads that were not solved, or at
    which a member has no value.
    """
    half = curve.over_quantities()
    for row, quantity in enumerate(BUDGET_QUANTITIES):
        low, high = _band(ensemble, quantity)
        size = curve.loading.area if quantity == "area_corrected" else 1.0
        # A band that ends at a bound is not even about the mean; its larger half counts.
        mean = ensemble[f"{_OF_ENSEMBLE[quantity]}_mean"].values
        half[row, _places(curve, ensemble)] = size * np.fmax(high - mean, mean - low)
    return half


def seated_spread(curve: LoadCurve, ensemble: xr.Dataset) -> np.ndarray:
    """Half-widths of :func:`ensemble_spread` of the closure from the seat, (normal_force), mm."""
    half, places = np.full(len(curve.forces), np.nan), _places(curve, ensemble)
    seat = np.flatnonzero(curve.curve["seated_closure"].values[places] == 0)
    if seat.size:
        closing = ensemble["interface_closure"].transpose("realisation", ...).values
        closed = closing - closing[:, seat[:1]]
        every = np.isfinite(closed).all(axis=0)
        half[places] = np.where(every, band_of(closed).width / 2, np.nan)
    return half


def position_in_band(curve: LoadCurve, ensemble: xr.Dataset) -> np.ndarray:
    """Position of the specimen relative to the band of its ensemble, (quantity, normal_force).

    :data:`INSIDE`, :data:`OUTSIDE`, or empty.
    """
    shape = len(BUDGET_QUANTITIES), len(curve.forces)
    position = np.full(shape, "", dtype=f"U{max(len(INSIDE), len(OUTSIDE))}")
    places = _places(curve, ensemble)
    for row, quantity in enumerate(BUDGET_QUANTITIES):
        low, high = _band(ensemble, quantity)
        stage = curve.domains if quantity == "delta_sigma" else curve.curve
        own = stage[_OF_ENSEMBLE[quantity]].values[places]
        edge = _ROUNDING * np.abs(own)
        said = np.where((low - edge <= own) & (own <= high + edge), INSIDE, OUTSIDE)
        position[row, places] = np.where(np.isfinite(own + low), said, "")
    return position


def _places(curve, ensemble):
    """Loads of an ensemble among those of the specimen."""
    return [int(np.argmin(np.abs(curve.forces - f))) for f in ensemble["normal_force"].values]


def _band(ensemble, quantity):
    """Ends of the band of a quantity; NaN where not every member has a value."""
    name = _OF_ENSEMBLE[quantity]
    every = ensemble[f"{name}_n"].values == ensemble.sizes["realisation"]
    return (
        np.where(every, ensemble[f"{name}_band_{end}"].values, np.nan) for end in ("low", "high")
    )
