"""Renormalisation of the contact area over resolutions and the size effect (eqs. 5 and 6)."""

from typing import Any

import numpy as np
import xarray as xr

from ..core.estimate import Estimate, names_of, rows_of
from ..core.fitting import fit_line
from ..core.intervals import LEFT_OUT, jackknife_error
from ..core.labels import cf_attrs

#: The dimension along which resolutions s, 2s, 4s ... are stored.
RESOLUTION = "resolution"

#: Nodes that a contact domain needs at a resolution for its number N_n to count.
MIN_NODES_PER_RESOLUTION = 4


def renormalisation(
    s: xr.DataArray,
    area: xr.DataArray,
    force: xr.DataArray,
    nodes: xr.DataArray | None = None,
    fewest: int = MIN_NODES_PER_RESOLUTION,
    left: xr.DataArray | None = None,
    sampling: xr.DataArray | None = None,
) -> xr.Dataset:
    """Dimension and fractal measure of the contact domain from its area over resolutions.

    The real area of the pre-fractals follows A_n ~ s_n^(2 - Delta_sigma), so that
    F = sigma_n A_n = sigma* H_D with H_D = N_n s_n^Delta_sigma the same at all of them (eq. 5).

    Parameters
    ----------
    s : DataArray (resolution,)
        Spacings, mm.
    area : DataArray (resolution, ...)
        Real contact area A_n, mm2. Areas of fewer than ``fewest`` nodes, and missing ones, are left
        out.
    force : DataArray (...)
        Force F, N, on any of the other dimensions of `area`.
    nodes : DataArray (resolution, ...), optional
        N_n, where areas are corrected ones; by default A_n / s_n^2.
    fewest : int
        Nodes that a domain needs to count.
    left : DataArray (resolution, ..., left_out), optional
        Fraction of the area that is left without each part of the domain, from
        :mod:`states.left_out`; without it only areas that no sample changes have an interval.
    sampling : DataArray (resolution, ...), optional
        Sampling errors of the areas: where all that are fitted are 0, as those of F/H where all
        contacts yield, the interval has no width.

    Returns
    -------
    xarray.Dataset
        On the other dimensions of `area`: `delta_sigma` with `_low`, `_high` (95 %), `n`
        resolutions fitted; `hausdorff_measure` (geometric mean over resolutions, mm^Delta);
        `sigma_star` = F / H_D, N mm^-Delta. On (resolution, ...): `sigma_n` = F / A_n, MPa, at the
        resolutions that count. NaN where fewer than three resolutions can be.

    Notes
    -----
    N_n is a whole number. One node more or less of one, two or three would change the
    slope over a doubling of s by 1, 0.6 or 0.4: such domains are too small to have a dimension (a
    single node at every resolution would give exactly 0). From
    `MIN_NODES_PER_RESOLUTION` = 4 on it is 0.3.

    The interval is of sampling: one part of the contact after another is left out at all
    resolutions together (jackknife), so that hills that carry more or less, which are the same at
    all of them, leave the slope as it is. Value and interval lie between 0 and 2, the bounds of a
    set in the plane. A misfit of the line is a bend of the law, a finding
    (:func:`area_bend`) and no error: an interval of the regression was four times too wide on
    joints, and beside their bend four points have one degree of freedom, too few for an interval.

    Raises
    ------
    ValueError
        If a spacing is not positive or an area is negative.
    """
    if not (s > 0).all():
        raise ValueError(f"spacings must be positive, not {s.values}")
    if (area < 0).any():
        raise ValueError(f"a contact area cannot be negative: {float(area.min())} mm2")
    nodes = area / s**2 if nodes is None else nodes
    touching = area.where(nodes >= fewest - 1e-6)
    value, low, high, n = _of_resolutions(_area_exponent, 4, s, touching, left, sampling)
    delta = (
        Estimate(value, low, high).mapped(lambda exponent: 2 - exponent, falling=True).in_plane()
    )
    measure = hausdorff_measure(s, touching, delta.value)
    measure = np.exp(np.log(measure).mean(RESOLUTION))
    values = {
        **delta.columns("delta_sigma"),
        "n": n.astype(int),
        "hausdorff_measure": measure,
        "sigma_star": force / measure,
        "sigma_n": force / touching,
    }
    return _described(values, _RENORMALISED)


#: Unit and long name of the results of renormalisation.
_RENORMALISED = {
    **rows_of("delta_sigma", "1", "dimension of the contact domain from A_r ~ s^(2 - Delta_sigma)"),
    "n": ("1", "resolutions fitted"),
    "hausdorff_measure": ("mm^delta_sigma", "fractal measure H_D of the contact domain"),
    "sigma_star": ("N mm^-delta_sigma", "fractal mean pressure sigma*"),
    "sigma_n": ("MPa", "real mean pressure at each resolution"),
}


def _described(values, words) -> xr.Dataset:
    """Dataset of arrays with dimensions of their own, with units and long names."""
    result = xr.Dataset(values)
    for name, (unit, long_name) in words.items():
        result[name].attrs = cf_attrs(unit, long_name)
    return result


def _of_resolutions(function, outputs, s, area, left, sampling) -> tuple[xr.DataArray, ...]:
    """Numbers of a function of log s, log A, log of the areas left, and whether A samples."""
    left = xr.full_like(area, np.nan).expand_dims({LEFT_OUT: 1}) if left is None else left
    free = xr.ones_like(area, dtype=bool) if sampling is None else sampling != 0
    with np.errstate(divide="ignore"):  # log of 0 where one part holds all nodes
        logs = np.log(s), np.log(area), np.log(left)
    return xr.apply_ufunc(
        function,
        *logs,
        free,
        input_core_dims=[[RESOLUTION], [RESOLUTION], [RESOLUTION, LEFT_OUT], [RESOLUTION]],
        output_core_dims=[[]] * outputs,
        vectorize=True,
    )


def _area_exponent(log_s, log_area, log_left, free) -> tuple[float, ...]:
    """Slope of log A over log s with its interval, and resolutions fitted."""
    line = fit_line(log_s, log_area)
    slope, fitted = line.slope.value, np.isfinite(log_area)
    about = fitted * (log_s - np.average(log_s, weights=fitted + 1e-300))
    half = _half(about / (about @ about or 1.0), log_left, free)
    return slope, slope - half, slope + half, float(line.n)


def _half(weights, log_left, free) -> float:
    """Half of the interval of a weighted sum of log A; 0 for areas that no sample changes."""
    counted = abs(weights) > 1e-12 * abs(weights).max()  # a middle point's weight is 0 to rounding
    if not free[counted].any():
        return 0.0
    if np.isinf(log_left[counted]).any():  # one part holds all nodes: the sum has no bound
        return np.inf
    replicates = weights[counted] @ log_left[counted]
    return jackknife_error(replicates) if np.isfinite(replicates).all() else np.nan


def hausdorff_measure(s: Any, area: Any, delta_sigma: Any) -> Any:
    """Fractal measure N_n s_n^Delta_sigma of each pre-fractal, mm^Delta_sigma.

    N_n = A_n / s_n^2 nodes, with the spacing s_n in mm and the real contact area A_n in mm2.
    """
    return area * s ** (delta_sigma - 2)


def nominal_pressure(sigma_star: Any, delta_sigma: Any, b: Any) -> Any:
    """Nominal pressure sigma* b^(Delta_sigma - 2), MPa, of a joint of side b, mm (eq. 6).

    ``sigma_star`` is the fractal mean pressure, N mm^-Delta_sigma.
    """
    return sigma_star * b ** (delta_sigma - 2)


def fractal_pressure(force: Any, side: Any, delta_sigma: Any) -> Any:
    """sigma* = F / H_D, N mm^-delta, with the fractal measure H_D = b^delta of the joint (eq. 5).

    So sigma_0 A_0 = sigma* H_D holds on the specimen itself, and eq. 6 passes through it. The
    measure N_n s_n^delta of the pre-fractals, ``hausdorff_measure`` in the atlas, differs from it
    by a factor without dimension, which eq. 6 does not contain. F is in N, the side b in mm.
    """
    return force / side**delta_sigma


def extrapolated_pressure(scaling: xr.Dataset, side: float) -> xr.Dataset:
    """Nominal pressures of joints of other sizes by eq. 6, which is fixed on the specimen.

    ``scaling`` has both estimates of Delta_sigma, from :func:`compare_dimensions`; ``side`` b of
    the specimen, mm, is that of the square as large as its window. The dataset has the coordinate
    ``estimator`` ("area", "box"): ``eq6_sigma_star``, and over ``eq6_side`` (`SIDES` times
    ``side``) ``eq6_pressure`` with the ends of its interval, which follow from those of
    Delta_sigma, each with its own sigma*.
    """
    force = scaling["normal_force"]
    sides = xr.DataArray(side * SIDES, dims="eq6_side")
    names = [names_of(f"delta_sigma_{estimator}") for estimator in ESTIMATORS]
    dimensions = [
        xr.concat([scaling[name] for name in of_end], "estimator")
        for of_end in zip(*names, strict=True)
    ]
    stars = [fractal_pressure(force, side, dimension) for dimension in dimensions]
    value, *ends = (
        nominal_pressure(star, dimension, sides)
        for star, dimension in zip(stars, dimensions, strict=True)
    )
    # The lines of both ends cross, so that the side b decides which is the lower.
    pressure = Estimate(value, np.fmin(*ends), np.fmax(*ends))
    values = {"eq6_sigma_star": stars[0], **pressure.columns("eq6_pressure")}
    coords = {
        "estimator": ("estimator", list(ESTIMATORS), cf_attrs("1", "source of Delta_sigma")),
        "eq6_side": ("eq6_side", sides.values, cf_attrs("mm", "side b of a joint in eq. 6")),
    }
    result = _described(values, _EXTRAPOLATED).assign_coords(coords)
    return result.transpose("estimator", *scaling["delta_sigma_area"].dims, "eq6_side")


#: Sources of the estimates of Delta_sigma.
ESTIMATORS = ("area", "box")
#: Sides b of joints that eq. 6 is extrapolated to, as multiples of the specimen's: two decades.
SIDES = np.array([0.1, 1.0, 10.0])

#: Unit and long name of the results of eq. 6 for other sizes.
_EXTRAPOLATED = {
    "eq6_sigma_star": ("N mm^-delta_sigma", "sigma* = F / b^Delta_sigma, which fixes eq. 6"),
    **rows_of("eq6_pressure", "MPa", "nominal pressure by eq. 6 on a joint of side b"),
}


def compare_dimensions(by_area: xr.Dataset, by_boxes: xr.Dataset) -> xr.Dataset:
    """Two estimates of Delta_sigma and their difference: from A_r(s) and from box counting.

    The ends of the difference combine the two intervals as those of independent estimates (root of
    the sum of squares). The estimates ``disagree`` where the interval of the difference leaves out
    zero.
    """
    area, area_low, area_high = (by_area[name] for name in names_of("delta_sigma"))
    box, box_low, box_high = (by_boxes[name] for name in names_of("delta_sigma"))
    difference = area - box
    low = difference - np.hypot(area - area_low, box_high - box)
    high = difference + np.hypot(area_high - area, box - box_low)
    values = {
        **Estimate(area, area_low, area_high).columns("delta_sigma_area"),
        **Estimate(box, box_low, box_high).columns("delta_sigma_box"),
        **Estimate(difference, low, high).columns("difference"),
        "disagree": (low > 0) | (high < 0),
    }
    return _described(values, _COMPARED)


#: Unit and long name of the two estimates and their difference.
_COMPARED = {
    **rows_of("delta_sigma_area", "1", "Delta_sigma from the contact area over resolutions"),
    **rows_of("delta_sigma_box", "1", "Delta_sigma from box counting"),
    **rows_of("difference", "1", "Delta_sigma from area less that from box counting"),
    "disagree": ("1", "the two estimates of Delta_sigma differ by more than their intervals"),
}


def area_bend(
    s: xr.DataArray,
    area: xr.DataArray,
    nodes: xr.DataArray,
    fewest: int = MIN_NODES_PER_RESOLUTION,
    left: xr.DataArray | None = None,
    sampling: xr.DataArray | None = None,
) -> Estimate:
    """Delta_sigma of the two finest resolutions less that of the two coarsest, from their areas.

    It is zero for one power law A_n ~ s_n^(2 - Delta_sigma). The interval is of sampling, as that
    of :func:`renormalisation`, whose parameters these are, s ascending. NaN where fewer than three
    resolutions count.
    """
    value, half = _of_resolutions(_bend, 2, s, area.where(nodes >= fewest), left, sampling)
    return Estimate(value, value - half, value + half)


def _bend(log_s, log_area, log_left, free) -> tuple[float, float]:
    """Difference of two slopes of log A over log s, and half of its interval."""
    counted = np.flatnonzero(np.isfinite(log_area))
    if counted.size < 3:
        return np.nan, np.nan
    weights = np.zeros(log_s.size)
    for (fine, coarse), sign in ((counted[:2], -1), (counted[-2:], 1)):
        step = sign / (log_s[coarse] - log_s[fine])
        weights[coarse] += step
        weights[fine] -= step
    return float(weights[counted] @ log_area[counted]), _half(weights, log_left, free)
