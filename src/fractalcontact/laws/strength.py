"""Shear strength of the joint from its dilatancy, and Barton and Bandis' law beside it (sect. 5).

The effective friction angle is the basic one plus the dilatancy angle (Goodman 1989, as the paper
has it). Nothing breaks in this model: at small offsets, where the faces climb their steepest
asperities, the sum can pass the vertical, and what is stated as strength is truncated at
:data:`core.limits.LARGEST_FRICTION_ANGLE` as in Barton's law. What was truncated is counted.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..core.estimate import Estimate, rows_of
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.limits import JRC_RANGE, LARGEST_FRICTION_ANGLE, MAX_TOUCHING
from ..core.settings import Friction, Material, StrengthSettings
from ..core.window import nominal_area, window_sides
from ..joint.barton import LABORATORY_LENGTH, barton_strength, scaled_joint
from ..joint.contact_strength import contact_strength
from ..joint.joint import rigid_dilatancy, sliding_axis
from ..joint.jrc import profile_roughness
from ..states.states import DIP, SOLVER_ERROR

#: Residual strength is the mean over the intervals beyond this fraction of the largest offset.
RESIDUAL_FROM = 0.5


def from_flush(offset: ArrayLike, dilatancy: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """A dilatancy curve of faces that match: it starts from v = 0 and delta = 0 under any load.

    Parameters
    ----------
    offset : (n,) array_like
        mm, ascending, >= 0.
    dilatancy : (n, ...) array_like
        mm.

    Returns
    -------
    offset : (m,) ndarray
    dilatancy : (m, ...) ndarray
    """
    offset, dilatancy = np.asarray(offset, float), np.asarray(dilatancy, float)
    slid = offset > 0
    flush = np.zeros((1, *dilatancy.shape[1:]))
    return np.r_[0.0, offset[slid]], np.concatenate([flush, dilatancy[slid]])


def dilatancy_angle(offset: ArrayLike, dilatancy: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Dilatancy angle i = atan(d delta / dv) between successive offsets.

    Parameters
    ----------
    offset : (n,) array_like
        v, mm, ascending. Where faces match, start it with :func:`from_flush`.
    dilatancy : (n, ...) array_like
        delta, mm.

    Returns
    -------
    midpoint : (n - 1,) ndarray
        Middle of the intervals, mm.
    angle : (n - 1, ...) ndarray
        Degrees.
    """
    offset, dilatancy = np.asarray(offset, float), np.asarray(dilatancy, float)
    step = np.diff(offset).reshape(-1, *[1] * (dilatancy.ndim - 1))
    angle = np.degrees(np.arctan2(np.diff(dilatancy, axis=0), step))
    return (offset[1:] + offset[:-1]) / 2, angle


def angles_with_errors(
    offset: ArrayLike, dilatancy: ArrayLike, error: ArrayLike
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Dilatancy angle by :func:`dilatancy_angle`, with its error bound.

    Parameters
    ----------
    offset, dilatancy
        As for :func:`dilatancy_angle`.
    error : (n, ...) array_like
        Bound on the error of each dilatancy, mm.

    Returns
    -------
    midpoint, angle
    off : (n - 1, ...) ndarray
        Bound on the error of each angle, degrees: both ends of an interval may be off, in opposite
        directions.
    """
    midpoint, angle = dilatancy_angle(offset, dilatancy)
    ends = [slopes_apart(offset, dilatancy, sign * np.asarray(error)) for sign in (-1, 1)]
    return midpoint, angle, abs(np.degrees(np.arctan(ends)) - angle).max(axis=0)


def slopes_apart(offset: ArrayLike, dilatancy: ArrayLike, off: ArrayLike) -> np.ndarray:
    """Slopes d delta/dv between successive offsets whose ends move apart by ``off``, mm."""
    dilatancy, off = np.asarray(dilatancy, float), np.asarray(off, float)
    step = np.diff(np.asarray(offset, float)).reshape(-1, *[1] * (dilatancy.ndim - 1))
    return (np.diff(dilatancy, axis=0) + off[1:] + off[:-1]) / step


def shear_strength(pressure: ArrayLike, friction_angle: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """tau = sigma_n tan(angle), the angle truncated to 0 and `LARGEST_FRICTION_ANGLE`.

    Parameters
    ----------
    pressure : array_like
        sigma_n, MPa.
    friction_angle : array_like
        Effective friction angle, degrees; NaN gives NaN.

    Returns
    -------
    strength : ndarray
        MPa.
    truncated : ndarray of int
        1 where the angle was truncated at the largest, -1 at 0, else 0.
    """
    angle = np.asarray(friction_angle, float)
    truncated = (angle > LARGEST_FRICTION_ANGLE).astype(int) - (angle < 0)
    angle = np.clip(angle, 0.0, LARGEST_FRICTION_ANGLE)
    return np.asarray(pressure) * np.tan(np.radians(angle)), truncated


def strength_with_error(
    pressure: ArrayLike, friction_angle: np.ndarray, off: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shear strength by :func:`shear_strength`, with its error bound.

    Parameters
    ----------
    pressure, friction_angle
        As for :func:`shear_strength`.
    off : ndarray
        Bound on the error of the angles, degrees.

    Returns
    -------
    strength, truncated
    error : ndarray
        MPa.
    """
    strength, truncated = shear_strength(pressure, friction_angle)
    ends = [shear_strength(pressure, friction_angle + sign * off)[0] for sign in (-1, 1)]
    return strength, truncated, abs(np.array(ends) - strength).max(axis=0)


def peak(midpoint: ArrayLike, values: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Largest value over the intervals (the first axis) and the offset where it is first reached.

    Returns
    -------
    value, where : ndarray
        NaN where there is no value.
    """
    values = np.asarray(values, float)
    if not len(values):
        return (np.full(values.shape[1:], np.nan),) * 2
    known = np.where(np.isfinite(values), values, -np.inf)
    any_known = np.isfinite(known).any(axis=0)
    highest = np.where(any_known, known.max(axis=0), np.nan)
    return highest, np.where(any_known, np.asarray(midpoint)[known.argmax(axis=0)], np.nan)


def residual(midpoint: ArrayLike, values: ArrayLike, largest: float) -> Estimate:
    """Mean over the intervals beyond `RESIDUAL_FROM` of the largest offset, with its interval.

    Returns
    -------
    Estimate
        With one interval of offsets there is no interval of the mean.
    """
    beyond = np.asarray(midpoint) >= RESIDUAL_FROM * largest
    return mean_interval(np.asarray(values, float)[beyond])


def joint_strength(
    dilatancy: xr.Dataset,
    joint: xr.Dataset,
    specimen: xr.Dataset,
    settings: StrengthSettings,
) -> xr.Dataset:
    """Dilatancy angle, friction angle and shear strength over the offsets, peak and residual.

    Parameters
    ----------
    dilatancy : xr.Dataset
        From :func:`laws.closure.elastic_dilatancy`.
    joint : xr.Dataset
        From :func:`joint.joint.describe_joint`.
    specimen : xr.Dataset
        That slides: not one against a plane.
    settings : StrengthSettings
        What depends on a quantity that is not stated is NaN.

    Returns
    -------
    xr.Dataset
        Over (contact_direction, interval, normal_force), (contact_direction, normal_force) and
        (contact_direction, sampling): :data:`FIELDS` and what
        :func:`joint.jrc.profile_roughness` gives. What rests on solved states has an
        ``_error``, the solver's. ``interval`` holds midpoints of the offsets in the first
        direction, ``midpoint`` those of each.

    Notes
    -----
    Barton's phi_r is taken as the basic angle (faces that are not weathered), his JRC_0 as that of
    the window: Z2 at a fixed step hardly depends on the length of the profile. His correction for
    scale then goes from `LABORATORY_LENGTH` to the window's own length along the sliding.
    """
    material = settings.material
    pressure = dilatancy["normal_force"].values / nominal_area(specimen)
    directions = [str(d) for d in dilatancy["contact_direction"].values]
    parts = [
        _one_direction(dilatancy, joint, specimen, material, direction, pressure)
        for direction in directions
    ]
    result = xr.concat(parts, "contact_direction", join="override", combine_attrs="override")
    result = result.assign_coords(
        contact_direction=directions,
        normal_force=dilatancy["normal_force"],
        offset=dilatancy["offset"],
        interval=("interval", result["midpoint"].values[0], cf_attrs("mm", FIELDS["midpoint"][1])),
    )
    result["nominal_pressure"] = (
        "normal_force",
        pressure,
        cf_attrs("MPa", "nominal pressure sigma_0"),
    )
    for name, units, words in (
        ("basic_friction_angle", "degree", "basic friction angle phi_b"),
        ("joint_wall_strength", "MPa", "joint wall compressive strength JCS"),
    ):
        result[name] = ((), float(getattr(material, name)), cf_attrs(units, words))
    return result


_QUANTITIES = {
    "midpoint": ("mm", "middle of the interval of offsets"),
    "dilatancy_angle": ("degree", "dilatancy angle i"),
    "rigid_dilatancy_angle": ("degree", "dilatancy angle of the rigid joint, F = 0"),
    "friction_angle": ("degree", "effective friction angle phi_b + i, not truncated"),
    "shear_strength": ("MPa", "shear strength tau"),
    "truncated_high": (
        "1",
        f"intervals whose angle was truncated at {LARGEST_FRICTION_ANGLE:g} degrees",
    ),
    "truncated_low": ("1", "intervals whose angle was truncated at 0"),
    "shear_strength_valid": ("1", "the shear strength is a result"),
    "shear_strength_reason": ("1", "why the shear strength is no result"),
    "peak_strength_valid": ("1", "the peak strength is a result"),
    "peak_strength_reason": ("1", "why the peak strength is no result"),
    "peak_strength": ("MPa", "largest shear strength over the offsets"),
    "peak_offset": ("mm", "offset where it is first reached"),
    "peak_dilatancy_angle": ("degree", "largest dilatancy angle over the offsets"),
    **rows_of("residual_strength", "MPa", "mean shear strength beyond half of the largest offset"),
    **rows_of("residual_angle", "degree", "mean dilatancy angle beyond half of the largest offset"),
    "residual_n": ("1", "intervals beyond half of the largest offset"),
    "barton_strength": ("MPa", "peak strength by Barton's law"),
    "peak_over_barton": ("1", "largest shear strength over the peak by Barton's law"),
    "scaled_roughness": ("1", "JRC_n for the window's length; missing above 20"),
    "scaled_wall_strength": ("MPa", "JCS_n for the window's length"),
    "barton_scaled_strength": ("MPa", "peak strength by Barton's law with JRC_n and JCS_n"),
}

#: What rests on solved states, and has a solver error bound for that.
_SOLVED = (
    "dilatancy_angle",
    "friction_angle",
    "shear_strength",
    "peak_strength",
    "peak_dilatancy_angle",
)
#: Why a strength by dilatancy is no result.
TRUNCATED = f"friction and dilatancy angles together exceed {LARGEST_FRICTION_ANGLE:g} degrees"
FULL = "half of the window touches, so that the faces no longer ride on asperities"

#: Unit and long name of each quantity.
FIELDS = _QUANTITIES | {
    f"{name}_error": (_QUANTITIES[name][0], f"{_QUANTITIES[name][1]}, {SOLVER_ERROR}")
    for name in _SOLVED
}


def _one_direction(
    dilatancy: xr.Dataset,
    joint: xr.Dataset,
    specimen: xr.Dataset,
    material: Material,
    direction: str,
    pressure: np.ndarray,
) -> xr.Dataset:
    """All of :func:`joint_strength` for one direction."""
    angle_b = material.basic_friction_angle
    largest = dilatancy["offset_on_grid"].sel(contact_direction=direction).values[-1]
    curves = _curves_with_rigid(dilatancy, joint, specimen, direction)
    midpoint, angles, angles_off = angles_with_errors(*curves)
    rigid_angle, angle, angle_off = angles[:, 0], angles[:, 1:], angles_off[:, 1:]
    tau, truncated, tau_off = strength_with_error(pressure, angle_b + angle, angle_off)
    stated = np.where(np.isfinite(angle_b), 1.0, np.nan)
    values = {
        "midpoint": midpoint,
        "dilatancy_angle": angle,
        "rigid_dilatancy_angle": rigid_angle,
        "friction_angle": angle_b + angle,
        "shear_strength": tau,
        "truncated_high": stated * (truncated > 0).sum(axis=0),
        "truncated_low": stated * (truncated < 0).sum(axis=0),
        "peak_dilatancy_angle": peak(midpoint, angle)[0],
        "dilatancy_angle_error": angle_off,
        "friction_angle_error": stated * angle_off,
        "shear_strength_error": tau_off,
        # The largest of several values is off by no more than the one that is off most.
        "peak_strength_error": peak(midpoint, tau_off)[0],
        "peak_dilatancy_angle_error": peak(midpoint, angle_off)[0],
    }
    values["peak_strength"], values["peak_offset"] = peak(midpoint, tau)
    for name, of_intervals in (("strength", tau), ("angle", angle)):
        mean = residual(midpoint, of_intervals, largest)
        values |= mean.columns(f"residual_{name}") | {"residual_n": mean.n}

    roughness = profile_roughness(specimen, direction)
    side = window_sides(specimen)[sliding_axis(direction)]
    values |= _by_barton(roughness["jrc_used"].item(), material, side, pressure)
    # Contacts that yield carry their hardness: the pressure says how much of the window touches.
    full = pressure >= MAX_TOUCHING * material.hardness
    values |= judged_strengths(values, full)
    table = {name: (_dims(name, of_name), *FIELDS[name]) for name, of_name in values.items()}
    result = roughness.assign(labelled(table, values))
    if DIP in dilatancy:
        dips = dilatancy[DIP].sel(contact_direction=direction)
        result = result.assign(contact_strength(dips, pressure, angle_b))
    result["scaled_roughness"].attrs["laboratory_length_mm"] = LABORATORY_LENGTH
    return result


def judged_strengths(values: Mapping[str, ArrayLike], full: np.ndarray) -> dict[str, np.ndarray]:
    """Validity of shear and peak strengths, and the peaks over Barton's.

    Parameters
    ----------
    values : mapping of str to array_like
        ``midpoint`` (n,), ``friction_angle`` (n, load), ``peak_strength``, ``peak_offset`` and
        ``barton_strength`` (load,) of one direction.
    full : (load,) ndarray of bool
        Where more than :data:`core.limits.MAX_TOUCHING` of the window touches.
    """
    midpoint, angle, peak_offset, peaks, barton = (
        np.asarray(values[name])
        for name in (
            "midpoint",
            "friction_angle",
            "peak_offset",
            "peak_strength",
            "barton_strength",
        )
    )
    truncated = angle > LARGEST_FRICTION_ANGLE
    at_peak = np.equal.outer(midpoint, peak_offset)
    cut = (truncated & at_peak).any(axis=0)
    return {
        "shear_strength_valid": ~truncated & ~full,
        "shear_strength_reason": np.where(full, FULL, np.where(truncated, TRUNCATED, "")),
        "peak_strength_valid": ~cut & ~full,
        "peak_strength_reason": np.where(full, FULL, np.where(cut, TRUNCATED, "")),
        "peak_over_barton": peaks / barton,
    }


def _curves_with_rigid(
    dilatancy: xr.Dataset, joint: xr.Dataset, specimen: xr.Dataset, direction: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offsets (n,), dilatancy and its error (n, 1 + load), mm, the rigid joint's first."""
    curve = dilatancy.sel(contact_direction=direction)
    cells = joint["offset_cells"].sel(contact_direction=direction).values
    rigid, _ = rigid_dilatancy(specimen, direction, cells)
    offset = curve["offset_on_grid"].values
    elastic, error = (
        curve[name].transpose("offset", "normal_force").values
        for name in ("elastic_dilatancy", "elastic_dilatancy_error")
    )
    both = np.column_stack([rigid, elastic])
    # Openings of rigid faces are read off the heights.
    errors = np.column_stack([np.zeros_like(rigid), error])
    if specimen.attrs["opposite"] == "match":
        # Flush faces have no dilatancy, whatever the load: no error either.
        _, errors = from_flush(offset, errors)
        offset, both = from_flush(offset, both)
    return offset, both, errors


def _by_barton(jrc: float, material: Friction, side: float, pressure: np.ndarray) -> dict[str, Any]:
    """Barton's law with the JRC and JCS as they are, and scaled to the side of the window."""
    angle, wall = material.basic_friction_angle, material.joint_wall_strength
    scaled_jrc, scaled_wall = scaled_joint(jrc, wall, side)
    # Beyond Barton's scale there is nothing that his law was measured on.
    scaled_jrc = scaled_jrc if scaled_jrc <= JRC_RANGE[1] else np.nan
    return {
        "barton_strength": barton_strength(pressure, angle, jrc, wall),
        "scaled_roughness": scaled_jrc,
        "scaled_wall_strength": scaled_wall,
        "barton_scaled_strength": barton_strength(pressure, angle, scaled_jrc, scaled_wall),
    }


def _dims(name: str, values: ArrayLike) -> tuple[str, ...]:
    if name in ("midpoint", "rigid_dilatancy_angle"):
        return ("interval",)
    return {0: (), 1: ("normal_force",), 2: ("interval", "normal_force")}[np.ndim(values)]
