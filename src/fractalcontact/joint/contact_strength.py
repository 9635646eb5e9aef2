"""Shear strength from the contact itself: each node resists by basic friction and its dip.

A node that carries the pressure p on a face of apparent dip theta along the sliding resists it with
p tan(phi_b + theta), as a block on an incline does (Patton 1966); the joint with the sum of these.
It is a model of its own: dilatancy is the rise of the whole block, a mean over the way, whereas
this sum is of one state, and weighs the steep contacts by what they carry.
"""

import warnings

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..core.estimate import Estimate
from ..core.limits import LARGEST_FRICTION_ANGLE, MOSTLY_TRUNCATED
from ..core.window import faces, window_slices
from .joint import DIRECTION_STEPS, direction_spacing, sliding_axis

#: Equal parts of the force whose mean apparent dip is kept of every state.
PARTS = 100
#: Spacings that slopes are taken over: one, and another for the error of the grid.
STEPS = (1, 2)
_STATES = ("offset", "normal_force")
#: Variables of the stage strength: dimensions, unit, long name.
TABLE = {
    "contact_strength": (
        _STATES,
        "MPa",
        "shear strength from the contact itself, sum of p tan(phi_b + apparent dip)",
    ),
    "contact_strength_grid_error": (
        _STATES,
        "MPa",
        "change of it with slopes over twice the spacing, no interval",
    ),
    "contact_truncated": (
        _STATES,
        "1",
        f"fraction of the force at {LARGEST_FRICTION_ANGLE:g} degrees, where angles are truncated",
    ),
    "peak_contact_strength": (
        ("normal_force",),
        "MPa",
        "largest shear strength from the contact itself over the offsets",
    ),
    "peak_contact_strength_low": (
        ("normal_force",),
        "MPa",
        "lower end of it by the change of slopes over twice the spacing",
    ),
    "peak_contact_strength_high": (("normal_force",), "MPa", "upper end, at most by that angle"),
    "peak_contact_truncated": (("normal_force",), "1", "fraction of the force truncated there"),
    "peak_contact_valid": (("normal_force",), "1", "at most half of the force is truncated there"),
    "peak_contact_reason": (("normal_force",), "1", "why the peak is a lower bound and no result"),
}

#: Why a peak is no result.
A_BOUND = f"only a lower bound, as most angles are truncated at {LARGEST_FRICTION_ANGLE:g} degrees"


def contact_dips(
    specimen: xr.Dataset, direction: str, cells: int, factor: int, step: int = 1
) -> np.ndarray:
    """Apparent dip of the contact at every node of the window along the sliding, if it touches.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : {"E", "N", "W", "S"}
        Where the upper block slides.
    cells : int
        Offset in cells of the scan.
    factor : int
        Resolution k.
    step : int, optional
        Spacings of that resolution that a slope is taken over.

    Returns
    -------
    (ny, nx) ndarray
        Degrees, above 0 where the upper block has to climb; NaN where no slope is known.

    Notes
    -----
    Where faces meet at a node, the plane between them is no steeper than the slopes of both on
    either side allow: it lies between the middle two of these four, and their mean is taken. So a
    tip on a flank has the dip of the flank, and exchanging the faces changes nothing.
    """
    axis, sign = sliding_axis(direction), sum(DIRECTION_STEPS[direction])
    apart = factor * step
    spacing = apart * direction_spacing(specimen, direction)
    slopes = []
    for heights, slid in zip(faces(specimen), (cells * sign, 0), strict=True):
        window = list(window_slices(specimen))
        window[axis] = slice(window[axis].start + slid, window[axis].stop + slid)
        across = np.moveaxis(heights, axis, 0)
        along, other = window[axis], window[1 - axis]
        nodes = np.arange(along.start, along.stop, factor)
        across = across[:, other.start : other.stop : factor]
        for way in (apart, -apart):
            rows, here = nodes + way, across[nodes]
            inside = (rows >= 0) & (rows < len(across))
            beside = np.full(here.shape, np.nan)
            beside[inside] = across[rows[inside]]
            slopes.append(np.moveaxis((beside - here) / np.copysign(spacing, way), 0, axis))
    return np.degrees(np.arctan(sign * _nanmedian(np.array(slopes))))


def _nanmedian(values: np.ndarray) -> np.ndarray:
    """Median over the first axis of four, of those that are known."""
    a, b, c, d = values
    middle = np.maximum(np.minimum(a, b), np.minimum(c, d))
    middle = (middle + np.minimum(np.maximum(a, b), np.maximum(c, d))) / 2
    missing = ~np.isfinite(middle)  # at few nodes, by a rim
    with warnings.catch_warnings(action="ignore"):  # where none is known
        middle[missing] = np.nanmedian(values[:, missing], axis=0)
    return middle


def dips_by_force(pressure: np.ndarray, dips: np.ndarray) -> np.ndarray:
    """Mean apparent dip of each of :data:`PARTS` equal parts of the force, ascending, degrees.

    Parameters
    ----------
    pressure : (ny, nx) ndarray
        MPa.
    dips : (ny, nx) ndarray
        From :func:`contact_dips`; nodes without one are left out.

    Returns
    -------
    (PARTS,) ndarray
        NaN where nothing presses.
    """
    pressing = (pressure > 0) & np.isfinite(dips)
    if not pressing.any():
        return np.full(PARTS, np.nan)
    order = np.argsort(dips[pressing], kind="stable")
    weight, dip = pressure[pressing][order], dips[pressing][order]
    carried = np.concatenate([[0.0], np.cumsum(weight)])
    integral = np.concatenate([[0.0], np.cumsum(weight * dip)])
    ends = np.linspace(0, carried[-1], PARTS + 1)
    return np.diff(np.interp(ends, carried, integral)) / (carried[-1] / PARTS)


def friction_of_dips(dips: ArrayLike, basic_friction_angle: float) -> tuple:
    """Shear over normal force of contacts with these dips, and the fraction that is truncated.

    Parameters
    ----------
    dips : (..., PARTS) array_like
        Degrees, of equal parts of the force.
    basic_friction_angle : float
        Degrees; NaN gives NaN.

    Returns
    -------
    ratio, truncated : (...) ndarray
        The sum of phi_b and dip is truncated at `LARGEST_FRICTION_ANGLE` up and down, as Barton's.
    """
    angle = np.asarray(dips) + basic_friction_angle
    kept = np.clip(angle, -LARGEST_FRICTION_ANGLE, LARGEST_FRICTION_ANGLE)
    truncated = np.where(np.isnan(angle).any(-1), np.nan, (angle != kept).mean(-1))
    return np.tan(np.radians(kept)).mean(-1), truncated


def contact_strength(dips: xr.DataArray, pressure: np.ndarray, angle: float) -> xr.Dataset:
    """Strength from the contact itself in one direction at one resolution, over offsets and loads.

    Parameters
    ----------
    dips : xr.DataArray
        (offset, normal_force, dip_step, force_part), degrees; NaN of states with few nodes.
    pressure : (normal_force,) ndarray
        sigma_0, MPa.
    angle : float
        phi_b, degrees.

    Returns
    -------
    xr.Dataset
        :data:`TABLE`.
    """
    dips = dips.transpose("dip_step", *_STATES, "force_part")
    ratio, truncated = friction_of_dips(dips.values, angle)
    tau, twice = ratio * pressure
    error = np.abs(twice - tau)
    at = np.where(np.isnan(tau), -np.inf, tau).argmax(axis=0)
    peaks = [one[at, np.arange(tau.shape[1])] for one in (tau, error, truncated[0])]
    most = pressure * np.tan(np.radians(LARGEST_FRICTION_ANGLE))
    peak = Estimate.about(peaks[0], peaks[1], 0, most)
    valid = ~(peaks[2] > MOSTLY_TRUNCATED)
    values = {
        "contact_strength": tau,
        "contact_strength_grid_error": error,
        "contact_truncated": truncated[0],
        **peak.columns("peak_contact_strength"),
        "peak_contact_truncated": peaks[2],
        "peak_contact_valid": valid,
        "peak_contact_reason": np.where(valid, "", A_BOUND),
    }
    return xr.Dataset(labelled(TABLE, values))
