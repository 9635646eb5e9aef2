"""Power law of the real contact area, and the theories beside it."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.estimate import rows_of
from ..core.fitting import MIN_POINTS, fit_line
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.limits import CORRECTED_NODES, LIGHT_LOAD, RESOLVED_NODES
from ..core.per_curve import per_curve
from ..joint.joint import composite_topography, direction_spacing, offsets_of
from ..roughness.dimension import slope_statistics
from ..states.states import chosen_offset, error_attrs
from .area_theories import FLUSH, add_comparison, add_theories

#: Statistics of a composite topography, by their names in :func:`slope_statistics`.
STATISTICS = ("rms_slope", "m0", "m2", "m4")

#: kappa of the raw and of the corrected area.
AREA_SLOPE = "area slope kappa = (A_r/A_0) E* h'_rms / sigma_0"
CORRECTED_AREA_SLOPE = "area slope kappa, corrected area"

#: Raw and corrected area: prefix of names, variable, fewest nodes, long name of kappa.
_AREAS = (
    ("", "area", RESOLVED_NODES, AREA_SLOPE),
    ("corrected_", "area_corrected", CORRECTED_NODES, CORRECTED_AREA_SLOPE),
)

#: Why there is no law of the area.
FULL_CONTACT = "the faces touch everywhere at every load"


def composite_statistics(specimen: xr.Dataset, direction: str, cells: ArrayLike) -> xr.Dataset:
    """Slopes and spectral moments of the composite topography at offsets (n,) in cells.

    Over (offset,) at the scan's own spacing: :data:`STATISTICS`. Slopes are differences of
    neighbouring nodes and grow as the spacing falls: on a self-affine surface of H = 0.8 whose
    spectrum reaches to the smallest wave of the grid they give 0.93 to 0.94 of the slope of the
    waves themselves. Attributes: ``spacing_y``, ``spacing_x``, mm.
    """
    spacing = specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]
    cells = np.asarray(cells, int)
    of_offsets = [
        slope_statistics(composite_topography(specimen, direction, n), spacing)[list(STATISTICS)]
        for n in cells
    ]
    result = xr.concat(of_offsets, "offset", combine_attrs="override")
    offset = offsets_of(cells, direction_spacing(specimen, direction))
    result["offset"] = ("offset", offset, cf_attrs("mm", "shear offset v"))
    result.attrs = {"spacing_y": float(spacing[0]), "spacing_x": float(spacing[1])}
    return result


def joint_statistics(specimen: xr.Dataset, joint: xr.Dataset) -> xr.Dataset:
    """:data:`STATISTICS` over (direction, offset) of every direction whose contact is solved.

    Offsets ascend and are, as in :func:`states.states.combine`, those of the first direction.
    """
    directions = [str(name) for name in joint["contact_direction"].values]
    of_directions = [
        composite_statistics(
            specimen, name, joint["offset_cells"].sel(contact_direction=name).values
        ).sortby("offset")
        for name in directions
    ]
    result = xr.concat(of_directions, "direction", join="override", combine_attrs="override")
    return result.assign_coords(direction=directions)


def area_laws(
    curves: xr.Dataset,
    statistics: xr.Dataset,
    e_star: float,
    dimension: float,
    map_offset: float | None = None,
) -> xr.Dataset:
    """Growth of the real contact area with the force at the finest resolution, beside the theories.

    ``statistics`` are those of :func:`joint_statistics`, E* is in MPa, ``dimension`` is Delta_g of
    the surface for Majumdar and Bhushan's law (NaN leaves that out, and ``no_majumdar_bhushan``
    says why), and ``map_offset``, mm, is taken as by :func:`states.states.chosen_offset`.

    Over (direction, offset) the stage has the statistics, the law A_r ~ F^m of the corrected area
    and the means of kappa at light load, each with a reason where there is none; over the loads too
    the ``fitted`` and ``light`` ones, ``reduced_pressure``, both kappas with their solver error,
    and the fractions A_r/A_0 of the theories; and what :func:`laws.area_theories.add_comparison`
    and :func:`add_area_offset` add.

    Flush faces have no slope: kappa and all theories are NaN, and full contact is no law. The
    interval of a mean kappa is over loads on one surface; other surfaces scatter more (see
    :mod:`experiments.area_slope`). Fits and means take states of `RESOLVED_NODES` nodes or more,
    those of the corrected area of `CORRECTED_NODES`.
    """
    finest = curves.sel(resolution=curves["resolution"].min(), drop=True)
    finest, statistics = xr.align(finest, statistics, join="exact")
    spacing = statistics.attrs["spacing_y"], statistics.attrs["spacing_x"]
    # Fraction of the window that a node covers.
    node = np.prod(spacing) * finest["nominal_pressure"] / finest["normal_force"]
    result = statistics.copy()
    for prefix, name, fewest, _ in _AREAS:
        words = name.replace("_", ", ")
        share = finest["area_share"]
        fitted = (share > (fewest - 0.5) * node) & (share < 1 - 0.5 * node)
        attrs = cf_attrs("1", f"{fewest} nodes touch, not all: load used in fits of the {words}")
        result[f"{prefix}fitted"] = fitted.assign_attrs(attrs)
    law = {
        "area": finest["area_corrected"],
        "touching": finest["area_share"],
        "fitted": result["corrected_fitted"],
        "raw_fitted": result["fitted"],
        "force": finest["normal_force"],
    }
    result.update(per_curve(law, _law, _NAMES))
    _add_kappa(result, finest, e_star, node)
    add_theories(result, finest, e_star, dimension, float(np.sqrt(np.prod(spacing))))
    add_comparison(result)
    add_area_offset(result, map_offset)
    return result.transpose("direction", "offset", "normal_force", ...)


def add_area_offset(result: xr.Dataset, map_offset: float | None) -> None:
    """Add the offset whose areas are reported, mm: that of the contact maps.

    Where the faces are flush at that offset, another one is chosen, at which they are not.
    """
    rough = result["reduced_pressure"].notnull().all("normal_force")
    offsets = result["offset"].values
    chosen = [
        chosen_offset(map_offset, offsets[of_one] if of_one.any() else offsets)
        for of_one in rough.transpose("direction", "offset").values
    ]
    attrs = cf_attrs("mm", "offset whose areas are reported")
    result["area_offset"] = "direction", chosen, attrs


#: Law A_r ~ F^m of the corrected area: unit, long name.
_NAMES = {
    f"corrected_{name}": (units, f"{words}, corrected area")
    for name, (units, words) in {
        **rows_of("exponent", "1", "exponent m of real contact area against force"),
        **rows_of("unit_area", "mm2", "real contact area at 1 N by the fitted law"),
        "force_low": ("N", "smallest force fitted"),
        "force_high": ("N", "largest force fitted"),
        "n": ("1", "loads fitted"),
    }.items()
} | {"no_corrected_law": ("1", "reason why there is no law of the area, corrected")}


def _law(
    area: np.ndarray,
    touching: np.ndarray,
    fitted: np.ndarray,
    raw_fitted: np.ndarray,
    force: np.ndarray,
) -> dict[str, Any]:
    """Power law of the corrected area of one load curve, or the reason for none."""
    exponent, at_one, _ = fit_line(np.log(force[fitted]), np.log(area[fitted]))
    low, high = np.exp(exponent.over)
    reason = ""
    if exponent.n < MIN_POINTS:
        full = (touching > 0.5).all() and not raw_fitted.any()
        few = f"{exponent.n} of {MIN_POINTS} loads with {CORRECTED_NODES} nodes in contact"
        reason = FULL_CONTACT if full else f"{few}, but not all"
    return {
        **exponent.columns("corrected_exponent"),
        **at_one.mapped(np.exp).columns("corrected_unit_area"),
        "corrected_force_low": low,
        "corrected_force_high": high,
        "corrected_n": exponent.n,
        "no_corrected_law": reason,
    }


def _add_kappa(result: xr.Dataset, curves: xr.Dataset, e_star: float, node: xr.DataArray) -> None:
    """kappa of A/A0 = kappa sigma_0 / (E* h'_rms), raw and corrected, and its mean at light load.

    ``node`` is the fraction of the window that one node covers.
    """
    slope = result["rms_slope"].where(result["rms_slope"] > FLUSH)
    reduced = curves["nominal_pressure"] / (e_star * slope)
    result["reduced_pressure"] = reduced.assign_attrs(cf_attrs("1", "sigma_0 / (E* h'_rms)"))
    nominal = curves["normal_force"] / curves["nominal_pressure"]
    for prefix, name, fewest, words in _AREAS:
        attrs = cf_attrs("1", words)
        kappa = curves[name] / nominal / reduced
        error = curves[f"{name}_error"] / nominal / reduced
        result[f"{prefix}kappa"] = kappa.assign_attrs(attrs)
        result[f"{prefix}kappa_error"] = error.assign_attrs(error_attrs(attrs))
        light = (curves["area_share"] > (fewest - 0.5) * node) & (reduced <= LIGHT_LOAD)
        condition = f"{fewest} nodes in contact at sigma_0 / (E* h'_rms) <= {LIGHT_LOAD:g}"
        result[f"{prefix}light"] = light.assign_attrs(cf_attrs("1", condition))
        at_light = kappa.where(light).transpose(..., "normal_force")
        mean = mean_interval(at_light.values, axis=-1)
        text = f"mean of {words}, at light load"
        result.update(mean.variables(f"{prefix}mean_kappa", at_light.dims[:-1], "1", text))
        n = light.sum("normal_force")
        result[f"{prefix}mean_kappa_n"] = n.assign_attrs(cf_attrs("1", "loads in the mean"))
        # np.where, because xr.where drops the labels of the offsets.
        reason = np.where(
            np.isnan(slope.transpose(*n.dims)),
            "the faces are flush and have no slope",
            f"no load with {condition}",
        )
        result[f"no_{prefix}mean_kappa"] = n.copy(data=np.where(n > 0, "", reason)).assign_attrs(
            cf_attrs("1", f"why there is no mean of {words.split(' = ')[0]}")
        )
