"""Errors derived from the budget: of closure from the seat, contact fraction, stated stiffness."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..laws.seated_laws import at_reference_pressures
from .refinement import LoadCurve

_AT = ("reference_pressure",)
_TABLE = {
    "seated_closure_total": (
        ("normal_force",),
        "mm",
        "error of the closure from the seat as a property of this surface, half-width at 95 %",
    ),
    "seated_closure_relative": (("normal_force",), "1", "the same over the closure from the seat"),
    "seated_closure_scan": (
        ("normal_force",),
        "mm",
        "error of it by the two scans, contained in the total",
    ),
    "seated_closure_total_of_population": (
        ("normal_force",),
        "mm",
        "error of it as that of the surface the window is cut from, half-width at 95 %",
    ),
    "mean_gap_total": (
        ("normal_force",),
        "mm",
        "error of the mean gap as a property of this surface, half-width at 95 %",
    ),
    "mean_gap_total_of_population": (
        ("normal_force",),
        "mm",
        "error of it as that of the surface the window is cut from, half-width at 95 %",
    ),
    "contact_fraction_total": (
        ("normal_force",),
        "1",
        "error of the corrected A_r/A_0 as a property of this surface, half-width at 95 %",
    ),
    "reference_stiffness_total": (
        _AT,
        "MPa/mm",
        "error of the stiffness at a pressure as a property of this surface, half-width at 95 %",
    ),
    "reference_stiffness_total_of_population": (
        _AT,
        "MPa/mm",
        "error of it as that of the surface the window is cut from, half-width at 95 %",
    ),
}


def with_derived(
    budget: xr.Dataset,
    curve: LoadCurve,
    sampling: np.ndarray,
    of_scan: ArrayLike | None = None,
) -> xr.Dataset:
    """Error budget of one load curve with the errors of derived quantities, :data:`_TABLE`.

    ``sampling`` (normal_force,) is the sampling error of the closure from the seat, half-width at
    95 %, ``of_scan`` the error of two scans, both in mm. NaN where an error is not known.

    Closure from the seat is the difference of two separations, less the settlement of the blocks,
    which is exact: its error is the root sum of squares of theirs, plus the error of two scans,
    which is computed of the closure from the seat itself. First touch, which decides the error of
    the closure from there, is in neither. At the seat it is 0 by definition. What moves the mean
    planes apart widens the gap by as much. The stiffness at a pressure has the relative error of
    the neighbouring states, and none beyond states whose error is known.
    """
    states = curve.curve
    separation = budget["total"].sel(quantity="separation").values
    seated = states["seated_closure"].values
    seat = seated == 0
    own = _without_scan(budget, separation)
    at_seat = own[seat][0] if seat.any() else np.nan
    scan = 0.0 if of_scan is None else np.nan_to_num(of_scan)
    of_both = np.where(seat, 0.0, np.hypot(own, at_seat) + scan)
    stiffness = states["reference_stiffness"].values
    pressure = states["nominal_pressure"].values
    totals = [
        at_reference_pressures(pressure, budget[name].sel(quantity="stiffness").values) * stiffness
        for name in ("relative_total", "relative_total_of_population")
    ]
    of_seated = np.where(np.isfinite(seated), of_both, np.nan)
    relative = of_seated / np.where(seated > 0, seated, np.nan)
    population = np.hypot(of_seated, sampling)
    gap = budget["total_of_population"].sel(quantity="separation").values
    fraction = budget["total"].sel(quantity="area_corrected").values / curve.loading.area
    coords = {"reference_pressure": states["reference_pressure"]}
    of_scans = np.where(np.isfinite(seated), np.broadcast_to(scan, seated.shape), np.nan)
    values = (of_seated, relative, of_scans, population, separation, gap, fraction, *totals)
    table = labelled(_TABLE, dict(zip(_TABLE, values, strict=True)))
    return budget.assign_coords(coords).assign(table)


def _without_scan(budget: xr.Dataset, separation: np.ndarray) -> np.ndarray:
    """Total error of the separation (normal_force), mm, without the source scan."""
    if "source" not in budget.coords or "scan" not in budget["source"]:
        return separation
    scan = budget["error"].sel(quantity="separation", source="scan").values
    return separation - np.nan_to_num(scan)
