"""Shear strength of the joint from its dilatancy, and Barton and Bandis' law beside it (sect. 5).

The effective friction angle is the basic one plus the dilatancy angle (Goodman 1989, as the paper
has it). Nothing breaks in this model: at small offsets, where the faces climb their steepest
asperities, the sum can pass the vertical, and what is stated as strength is truncated at
:data:`core.limits.LARGEST_FRICTION_ANGLE` as in Barton's law. What was truncated is counted.
"""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.directions import DIRECTIONS
from ..core.estimate import Estimate, names_of
from ..core.intervals import mean_interval, t_quantile
from ..core.labels import cf_attrs
from ..core.limits import (
    ASSUMED_ANGLE_ERROR,
    BANDIS_LENGTHS,
    FRICTION_FACTORS,
    JRC_RANGE,
    LARGEST_FRICTION_ANGLE,
    MAX_TOUCHING,
)
from ..core.per_curve import per_curve
from ..core.settings import Friction, StrengthSettings
from ..core.verdicts import OFF_LENGTHS
from ..core.window import nominal_area, window_sides
from ..joint.barton import LABORATORY_LENGTH, barton_angle, barton_strength, scaled_joint
from ..joint.joint import rigid_dilatancy, sliding_axis
from ..joint.jrc import profile_roughness
from ..states.states import DIP, SOLVER_ERROR
from .contact_strength import NAMES as CONTACT_FIELDS
from .contact_strength import SAMPLED_BY, contact_strength

#: Kinds of variants of a joint: this window, others of the scan, its quarters, other readings.
OWN, WINDOW, QUARTER, READ = "this window", "other window", "quarter", "other reading"
#: Fraction of the largest offset beyond which the intervals enter the residual strength, their
#: mean.
RESIDUAL_FROM = 0.5


def from_flush(offset: ArrayLike, dilatancy: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """A dilatancy curve of faces that match: it starts from v = 0 and delta = 0 under any load.

    Offsets (n,) ascend from 0 or more, dilatancies (n, ...) likewise in mm.
    """
    offset, dilatancy = np.asarray(offset, float), np.asarray(dilatancy, float)
    slid = offset > 0
    flush = np.zeros((1, *dilatancy.shape[1:]))
    return np.r_[0.0, offset[slid]], np.concatenate([flush, dilatancy[slid]])


def dilatancy_angle(offset: ArrayLike, dilatancy: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Middle of intervals of offsets, mm, and dilatancy angle i = atan(d delta / dv), degrees.

    Offsets v (n,) ascend, dilatancies delta (n, ...) likewise in mm. Where faces match, start the
    curve with :func:`from_flush`.
    """
    offset, dilatancy = np.asarray(offset, float), np.asarray(dilatancy, float)
    step = np.diff(offset).reshape(-1, *[1] * (dilatancy.ndim - 1))
    angle = np.degrees(np.arctan2(np.diff(dilatancy, axis=0), step))
    return (offset[1:] + offset[:-1]) / 2, angle


def angles_with_errors(
    offset: ArrayLike, dilatancy: ArrayLike, error: ArrayLike
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middle of the intervals, mm, dilatancy angle and its error bound, degrees.

    As :func:`dilatancy_angle`, with a bound on the error of each dilatancy, mm: both ends of an
    interval may be off, in opposite directions.
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
    """tau = sigma_n tan(angle), MPa, the angle truncated to 0 and `LARGEST_FRICTION_ANGLE`.

    Effective friction angles are in degrees; NaN gives NaN. Second comes where the angle was
    truncated: 1 at the largest, -1 at 0, else 0.
    """
    angle = np.asarray(friction_angle, float)
    truncated = (angle > LARGEST_FRICTION_ANGLE).astype(int) - (angle < 0)
    angle = np.clip(angle, 0.0, LARGEST_FRICTION_ANGLE)
    return np.asarray(pressure) * np.tan(np.radians(angle)), truncated


def strength_with_error(
    pressure: ArrayLike, friction_angle: np.ndarray, off: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shear strength by :func:`shear_strength`, where it was truncated, and its error bound, MPa.

    ``off`` bounds the error of the angles, degrees.
    """
    strength, truncated = shear_strength(pressure, friction_angle)
    ends = [shear_strength(pressure, friction_angle + sign * off)[0] for sign in (-1, 1)]
    return strength, truncated, abs(np.array(ends) - strength).max(axis=0)


def peak(midpoint: ArrayLike, values: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Largest value over the intervals (the first axis) and the offset where it is first reached.

    NaN where there is no value.
    """
    values = np.asarray(values, float)
    if not len(values):
        return (np.full(values.shape[1:], np.nan),) * 2
    filled = np.where(np.isfinite(values), values, -np.inf)
    any_known = np.isfinite(filled).any(axis=0)
    highest = np.where(any_known, filled.max(axis=0), np.nan)
    return highest, np.where(any_known, np.asarray(midpoint)[filled.argmax(axis=0)], np.nan)


def residual(midpoint: ArrayLike, values: ArrayLike, largest: float) -> Estimate:
    """Mean over the intervals beyond `RESIDUAL_FROM` of the largest offset, with its interval."""
    beyond = np.asarray(midpoint) >= RESIDUAL_FROM * largest
    return mean_interval(np.asarray(values, float)[beyond])


def joint_strength(
    dilatancy: xr.Dataset,
    joint: xr.Dataset,
    specimen: xr.Dataset,
    settings: StrengthSettings,
) -> xr.Dataset:
    """Dilatancy angle, friction angle and shear strength over the offsets, peak and residual.

    ``dilatancy`` is that of :func:`laws.closure.elastic_dilatancy`; the specimen slides.
    :data:`FIELDS`, what :func:`joint.jrc.profile_roughness` gives and, where dips are known,
    :data:`laws.contact_strength.NAMES`, over ``contact_direction`` and others. ``interval`` holds
    midpoints of the offsets in the first direction, ``midpoint`` those of each. What depends on a
    quantity that is not stated is NaN.

    Barton's phi_r is taken as the basic angle (faces that are not weathered), his JRC_0 as that of
    the window: Z2 at a fixed step hardly depends on the length of the profile. His correction for
    scale then goes from `LABORATORY_LENGTH` to the window's own length along the sliding.
    """
    material = settings.material
    pressure = dilatancy["normal_force"].values / nominal_area(specimen)
    directions = dilatancy["contact_direction"]
    of_face = {
        str(d): profile_roughness(specimen, str(d)) for d in {*DIRECTIONS, *directions.values}
    }
    roughness = [of_face[str(d)] for d in directions.values]
    result = xr.concat(roughness, directions, combine_attrs="override")
    rose = _rose(of_face)
    of_direction = {
        "direction": directions,
        "offset": dilatancy["offset_on_grid"],
        "elastic": dilatancy["elastic_dilatancy"],
        "error": dilatancy["elastic_dilatancy_error"],
        "cells": joint["offset_cells"].sel(contact_direction=directions),
        "jrc": result["jrc_used"],
        "jrc_low": result["jrc_used_low"],
        "jrc_high": result["jrc_used_high"],
    }
    spread = angle_spread(dilatancy, specimen)
    strength = partial(
        _strength, specimen=specimen, settings=settings, pressure=pressure, spread=spread
    )
    result.update(per_curve(of_direction, strength, FIELDS, ("offset", "normal_force")))
    result["scaled_roughness"].attrs["laboratory_length_mm"] = LABORATORY_LENGTH
    if DIP in dilatancy:
        of_contact = partial(
            contact_strength, pressure=pressure, angle=material.basic_friction_angle
        )
        along = ("dip_step", "offset", "normal_force", "force_part")
        of_dips = {"dips": dilatancy[DIP], **{name: dilatancy[name] for name in SAMPLED_BY}}
        result.update(per_curve(of_dips, of_contact, CONTACT_FIELDS, along))
    interval = "interval", result["midpoint"].values[0], result["midpoint"].attrs
    result = result.assign_coords(
        normal_force=dilatancy["normal_force"], offset=dilatancy["offset"], interval=interval
    )
    attrs = cf_attrs("MPa", "nominal pressure sigma_0")
    result["nominal_pressure"] = ("normal_force", pressure, attrs)
    words = "spread of the peak dilatancy angle over windows and readings of the scans, 95 %"
    result["peak_angle_spread"] = ((), spread, cf_attrs("degree", words))
    result = result.merge(rose)
    lengths = cf_attrs("mm", "length of a block along the sliding")
    result = result.assign_coords(
        block_length=("block_length", np.array(settings.block_lengths, float), lengths),
        rule=list(RULES),
    )
    for name, units, words in (
        ("basic_friction_angle", "degree", "basic friction angle phi_b"),
        ("joint_wall_strength", "MPa", "joint wall compressive strength JCS"),
    ):
        result[name] = ((), float(getattr(material, name)), cf_attrs(units, words))
    _add_friction_interval(result, material)
    return result


#: Peak strengths by every rule, whose intervals hold the uncertainty of phi_b; by Barton's law.
PEAKS = ("peak_strength", "peak_contact_strength", "barton_strength", "barton_scaled_strength")
_OF_BARTON = PEAKS[2:]


def _add_friction_interval(strength: xr.Dataset, material: Friction) -> None:
    """Intervals of the :data:`PEAKS`: their own errors and those of phi_b, by squares.

    :data:`core.limits.FRICTION_FACTORS` are of a strength; those of an assumed phi_b were seen
    beside Barton's law alone. By the other rules an assumed phi_b is off by `ASSUMED_ANGLE_ERROR`.
    """
    source = material.basic_friction_angle_is
    pressure = strength["nominal_pressure"]
    for name in PEAKS:
        if name not in strength:
            continue
        for end, factor in zip(("low", "high"), FRICTION_FACTORS[source], strict=True):
            value = strength[name]
            own = strength[f"{name}_{end}"] - value
            if f"{name}_error" in strength:
                # A scan may have no other windows and readings: then the solver's error is left.
                own = own.fillna(strength[f"{name}_error"])
            of_angle = (factor - 1) * value
            if source == "assumed" and name not in _OF_BARTON:
                sign = -1 if end == "low" else 1
                angle = np.degrees(np.arctan(value / pressure)) + sign * ASSUMED_ANGLE_ERROR
                of_angle = value.copy(data=shear_strength(pressure, angle)[0]) - value
            half = np.hypot(own, of_angle)
            title = value.attrs["long_name"]
            words = f"{end} end of {title}: own error at 95 %, phi_b {source}"
            limit = value + half if end == "high" else (value - half).clip(0)
            # No rule gives more than that angle.
            steepest = np.tan(np.radians(LARGEST_FRICTION_ANGLE)) * pressure
            limit = xr.where(limit > steepest, np.maximum(steepest, value), limit)
            limit = limit.transpose(*value.dims).drop_vars(set(limit.coords) - set(value.coords))
            strength[f"{name}_{end}"] = limit.assign_attrs(cf_attrs("MPa", words))
    strength.attrs["basic_friction_angle_is"] = source


_EACH, _LOAD = ("interval", "normal_force"), ("normal_force",)
_BLOCK = ("rule", "block_length", "normal_force")
_QUANTITIES = {
    "midpoint": ("mm", "middle of the interval of offsets", "interval"),
    "dilatancy_angle": ("degree", "dilatancy angle i", *_EACH),
    "rigid_dilatancy_angle": ("degree", "dilatancy angle of the rigid joint, F = 0", "interval"),
    "friction_angle": ("degree", "effective friction angle phi_b + i, not truncated", *_EACH),
    "shear_strength": ("MPa", "shear strength tau", *_EACH),
    "truncated_high": (
        "1",
        f"intervals whose angle was truncated at {LARGEST_FRICTION_ANGLE:g} degrees",
        *_LOAD,
    ),
    "truncated_low": ("1", "intervals whose angle was truncated at 0", *_LOAD),
    "shear_strength_valid": ("1", "the shear strength is a result", *_EACH),
    "shear_strength_reason": ("1", "why the shear strength is no result", *_EACH),
    "peak_strength_valid": ("1", "the peak strength is a result", *_LOAD),
    "peak_strength_reason": ("1", "why the peak strength is no result", *_LOAD),
    "peak_strength": ("MPa", "largest shear strength over the offsets", *_LOAD),
    "peak_offset": ("mm", "offset where it is first reached", *_LOAD),
    "peak_dilatancy_angle": ("degree", "largest dilatancy angle over the offsets", *_LOAD),
    "residual_strength": ("MPa", "mean shear strength beyond half of the largest offset", *_LOAD),
    "residual_n": ("1", "intervals beyond half of the largest offset", *_LOAD),
    "barton_strength": ("MPa", "peak strength by Barton's law", *_LOAD),
    "barton_strength_valid": ("1", "the strength by Barton's law is a result", *_LOAD),
    "barton_strength_reason": ("1", "why it is only a lower bound", *_LOAD),
    "peak_over_barton": ("1", "largest shear strength over the peak by Barton's law", *_LOAD),
    "scaled_roughness": ("1", "JRC_n for the window's length; missing above 20"),
    "scaled_wall_strength": ("MPa", "JCS_n for the window's length"),
    "barton_scaled_strength": ("MPa", "peak strength by Barton's law with JRC_n and JCS_n", *_LOAD),
    "barton_scaled_reason": ("1", "why there is no strength by JRC_n and JCS_n"),
    "barton_scaled_strength_valid": ("1", "the strength by JRC_n and JCS_n is a result", *_LOAD),
    "barton_scaled_strength_reason": ("1", "why there is none, or only a lower bound", *_LOAD),
    "block_strength": ("MPa", "peak strength of a block of a length, by rule", *_BLOCK),
    "block_reason": ("1", "why there is none", *_BLOCK),
}

#: Quantities that rest on solved states, and have a solver error bound for that.
_SOLVED = (
    "dilatancy_angle",
    "friction_angle",
    "shear_strength",
    "peak_strength",
    "peak_dilatancy_angle",
)
#: Rules for the strength of blocks.
RULES = ("dilatancy", "contact", "Barton", "Barton and Bandis")
#: Reasons why a rule has no strength for a length.
ABOVE_SCALE = "JRC_n, JRC scaled to that length, is above 20, where Barton's law ends"
UNSCALED = f"JRC and JCS are those of {LABORATORY_LENGTH:g} mm"
OF_WINDOW = "computed for the window alone: no law carries it to another length"
#: Relative difference of a length from the laboratory's.
_LIKE_LABORATORY = 0.01

#: Reasons why a strength by dilatancy is no result.
TRUNCATED = f"friction and dilatancy angles together exceed {LARGEST_FRICTION_ANGLE:g} degrees"
BARTON_TRUNCATED = (
    f"only a lower bound: phi_b + JRC log10(JCS/sigma) exceeds {LARGEST_FRICTION_ANGLE:g} degrees, "
    "where Barton's law is cut off"
)
HALF_TOUCHES = "half of the window touches, so that the faces no longer ride on asperities"

#: Quantities of one direction: unit, long name, dimensions.
FIELDS = _QUANTITIES | {
    f"{name}_error": (units, f"{words}, {SOLVER_ERROR}", *dims)
    for name, (units, words, *dims) in _QUANTITIES.items()
    if name in _SOLVED
}


def _strength(
    direction: np.ndarray,
    offset: np.ndarray,
    elastic: np.ndarray,
    error: np.ndarray,
    cells: np.ndarray,
    jrc: np.ndarray,
    jrc_low: np.ndarray,
    jrc_high: np.ndarray,
    *,
    specimen: xr.Dataset,
    settings: StrengthSettings,
    pressure: np.ndarray,
    spread: float,
) -> dict[str, Any]:
    """:data:`FIELDS` of one direction, from its elastic dilatancy (offset, load) and error, mm.

    ``spread``, degrees, is that of the peak angle over windows and readings of the scans.
    """
    material = settings.material
    angle_b, largest = material.basic_friction_angle, offset[-1]
    rigid, _ = rigid_dilatancy(specimen, str(direction), cells)
    # Openings of rigid faces are read off the heights: they have no solver error.
    curves = np.column_stack([rigid, elastic])
    errors = np.column_stack([np.zeros_like(rigid), error])
    if specimen.attrs["opposite"] == "match":
        # Flush faces have no dilatancy under any load, and no error of it.
        _, errors = from_flush(offset, errors)
        offset, curves = from_flush(offset, curves)
    midpoint, angles, angles_off = angles_with_errors(offset, curves, errors)
    rigid_angle, angle, angle_off = angles[:, 0], angles[:, 1:], angles_off[:, 1:]
    tau, truncated, tau_off = strength_with_error(pressure, angle_b + angle, angle_off)
    stated = np.where(np.isfinite(angle_b), 1.0, np.nan)
    residual_strength = residual(midpoint, tau, largest)
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
        # The error of the largest of several values is at most the largest of their errors.
        "peak_strength_error": peak(midpoint, tau_off)[0],
        "peak_dilatancy_angle_error": peak(midpoint, angle_off)[0],
        "residual_strength": residual_strength,
        "residual_n": residual(midpoint, angle, largest).n,
    }
    values["peak_strength"], values["peak_offset"] = peak(midpoint, tau)
    side = window_sides(specimen)[sliding_axis(str(direction))]
    of_face = Estimate(float(jrc), float(jrc_low), float(jrc_high))
    values |= _by_barton(of_face, material, side, pressure)
    values |= _of_blocks(of_face, settings, pressure)
    # Yielding contacts carry their hardness, so that the pressure tells the fraction in contact.
    judged = judged_strengths(values, pressure >= MAX_TOUCHING * material.hardness)
    return values | judged | _with_spread(values, pressure, angle_b, spread)


def judged_strengths(values: Mapping[str, ArrayLike], full: np.ndarray) -> dict[str, np.ndarray]:
    """Validity of shear and peak strengths of one direction, and the peaks over Barton's.

    ``values`` has ``midpoint`` (n,), ``friction_angle`` (n, load), ``peak_strength``,
    ``peak_offset`` and ``barton_strength`` (load,); ``full`` (load,) is True where more than
    :data:`core.limits.MAX_TOUCHING` of the window touches.
    """
    midpoint, angle, peak_offset, peaks, barton = (
        np.asarray(getattr(values[name], "value", values[name]))
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
        "shear_strength_reason": np.where(full, HALF_TOUCHES, np.where(truncated, TRUNCATED, "")),
        "peak_strength_valid": ~cut & ~full,
        "peak_strength_reason": np.where(full, HALF_TOUCHES, np.where(cut, TRUNCATED, "")),
        "peak_over_barton": peaks / barton,
    }


def _with_spread(
    values: Mapping[str, Any], pressure: np.ndarray, angle_b: float, spread: float
) -> dict[str, Estimate]:
    """Peak angle and peak strength by dilatancy with intervals that hold windows and scans."""
    angle = values["peak_dilatancy_angle"]
    half = np.hypot(values["peak_dilatancy_angle_error"], spread)
    angles = Estimate.about(angle, half, -LARGEST_FRICTION_ANGLE, 90.0)
    low, high = (shear_strength(pressure, angle_b + end)[0] for end in (angle - half, angle + half))
    peaks = values["peak_strength"]
    # Several intervals may be truncated at the same angle: ends hold the value all the same.
    strengths = Estimate(peaks, np.minimum(low, peaks), np.maximum(high, peaks))
    return {"peak_dilatancy_angle": angles, "peak_strength": strengths}


def _by_barton(
    jrc: Estimate, material: Friction, side: float, pressure: np.ndarray
) -> dict[str, Any]:
    """Barton's law with the JRC and JCS as they are, and scaled to the side of the window.

    Intervals are those of the JRC, over the profiles of the face.
    """
    angle, wall = material.basic_friction_angle, material.joint_wall_strength
    scaled_jrc, scaled_wall, reason = _scaled(jrc, wall, side)
    own, scaled = (
        _truncated_by_barton(pressure, angle, *joint)
        for joint in ((float(jrc.value), wall), (scaled_jrc, scaled_wall))
    )
    return {
        "barton_strength": _over_pressures(jrc, wall, angle, pressure),
        "barton_strength_valid": own == "",
        "barton_strength_reason": own,
        "scaled_roughness": scaled_jrc,
        "scaled_wall_strength": scaled_wall,
        "barton_scaled_strength": _by_bandis(jrc, material, side, pressure),
        "barton_scaled_reason": reason,
        "barton_scaled_strength_valid": scaled == "",
        "barton_scaled_strength_reason": np.full(pressure.shape, reason) if reason else scaled,
    }


def _truncated_by_barton(
    pressure: np.ndarray, angle: float, roughness: float, wall: float
) -> np.ndarray:
    """Reasons (load,) why a strength by Barton's law is no result; empty where it is one."""
    is_cut = barton_angle(pressure, angle, roughness, wall) > LARGEST_FRICTION_ANGLE
    return np.where(is_cut, BARTON_TRUNCATED, "")


def _over_pressures(jrc: Estimate, wall: float, angle: float, pressure: np.ndarray) -> Estimate:
    """Strength by Barton's law over pressures, MPa, with the ends of the JRC."""
    value, low, high = (np.asarray(barton_strength(pressure, angle, end, wall)) for end in jrc.ends)
    return Estimate(value, low, high)


def _by_bandis(jrc: Estimate, material: Friction, length: float, pressure: np.ndarray) -> Estimate:
    """Strength by Barton's law with JRC_n and JCS_n, with the ends of the JRC.

    The smaller JRC_n is not always that of the smaller JRC: the ends are sorted. An end whose JRC_n
    is beyond Barton's scale has the largest JRC of that scale.
    """
    angle, wall = material.basic_friction_angle, material.joint_wall_strength
    value = np.asarray(barton_strength(pressure, angle, *_scaled(jrc, wall, length)[:2]))
    ends = []
    for end in jrc.ends[1:]:
        scaled_jrc, scaled_wall = scaled_joint(end, wall, length)
        on_scale = np.minimum(scaled_jrc, JRC_RANGE[1])
        ends.append(np.asarray(barton_strength(pressure, angle, on_scale, scaled_wall)))
    low, high = np.min([value, *ends], axis=0), np.max([value, *ends], axis=0)
    return Estimate(value, low, high)


def _scaled(jrc: Estimate, wall: float, length: float) -> tuple[float, float, str]:
    """JRC_n and JCS_n of a joint of a length, mm, and why there is none; NaN then."""
    if not BANDIS_LENGTHS[0] <= length <= BANDIS_LENGTHS[1]:
        return np.nan, np.nan, OFF_LENGTHS
    scaled_jrc, scaled_wall = (float(of) for of in scaled_joint(jrc.value, wall, length))
    if scaled_jrc > JRC_RANGE[1]:
        # Barton's law was not measured on joints beyond his scale.
        return np.nan, scaled_wall, ABOVE_SCALE
    return scaled_jrc, scaled_wall, ""


def _of_blocks(
    jrc: Estimate, settings: StrengthSettings, pressure: np.ndarray
) -> dict[str, np.ndarray]:
    """Peak strengths (rule, block_length, load) of blocks of stated lengths, with reasons."""
    material, lengths = settings.material, settings.block_lengths
    angle, wall = material.basic_friction_angle, material.joint_wall_strength
    strengths = np.full((len(RULES), len(lengths), len(pressure)), np.nan)
    reasons = np.full(strengths.shape, OF_WINDOW, object)
    for i, length in enumerate(lengths):
        scaled_jrc, scaled_wall, unscalable = _scaled(jrc, wall, length)
        like_laboratory = np.isclose(length, LABORATORY_LENGTH, rtol=_LIKE_LABORATORY)
        by_rule = {
            "Barton": (
                _over_pressures(jrc, wall, angle, pressure).value,
                "" if like_laboratory else UNSCALED,
                _truncated_by_barton(pressure, angle, float(jrc.value), wall),
            ),
            "Barton and Bandis": (
                _by_bandis(jrc, material, length, pressure).value,
                unscalable,
                _truncated_by_barton(pressure, angle, scaled_jrc, scaled_wall),
            ),
        }
        for rule, (strength, no_law, truncated) in by_rule.items():
            row = RULES.index(rule)
            reasons[row, i] = no_law or truncated
            strengths[row, i] = np.where(reasons[row, i] == "", strength, np.nan)
    return {"block_strength": strengths, "block_reason": reasons.astype(str)}


def _rose(of_face: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Roughness of the whole face in four directions, from that of each."""
    names = {
        "face_jrc": "jrc_of_law",
        "face_grasselli": "grasselli_roughness",
    }
    directions = xr.DataArray(
        list(DIRECTIONS), dims="face_direction", attrs=cf_attrs("1", "direction of sliding")
    )
    return xr.Dataset(
        {
            of: xr.concat(
                [of_face[d][name] for d in DIRECTIONS], directions, combine_attrs="override"
            )
            for new, old in names.items()
            for of, name in zip(names_of(new), names_of(old), strict=True)
        }
    ).assign_coords(face_direction=directions)


def angle_spread(dilatancy: xr.Dataset, specimen: xr.Dataset) -> float:
    """Spread of the peak dilatancy angle over windows and readings of the scans, degrees.

    Half-width at 95 %: root sum of squares of Student's t times the standard deviation over the
    windows, this one among them, or over its quarters, and of the distance of the farthest reading;
    from :func:`laws.slid_variants.slid_variants`. NaN where the stage has none.
    """
    if "variant_dilatancy" not in dilatancy:
        return np.nan
    curves = dilatancy["variant_dilatancy"]
    along = dilatancy["offset_on_grid"].sel(contact_direction=curves.attrs["direction"])
    offset, delta = along.values, curves.transpose("offset", "variant").values
    if specimen.attrs["opposite"] == "match":
        offset, delta = from_flush(offset, delta)
    peaks, _ = peak(*dilatancy_angle(offset, delta))
    kinds = dilatancy["variant_kind"].values.astype(str)
    own, read = peaks[kinds == OWN], peaks[kinds == READ]
    quarters = peaks[kinds == QUARTER]
    windows = quarters if quarters.size else np.append(own, peaks[kinds == WINDOW])
    independent = float(dilatancy["windows_independent"])
    half = t_quantile(independent - 1) * windows.std(ddof=1) if windows.size > 1 else np.nan
    return float(np.hypot(half, np.abs(read - own).max(initial=0.0)))
