"""Shear strength from the contact itself: each node resists by basic friction and its dip.

A node that carries the pressure p on a face of apparent dip theta along the sliding resists it with
p tan(phi_b + theta), as a block on an incline does (Patton 1966); the joint with the sum of these.
It is a model of its own: dilatancy is the rise of the whole block, a mean over the way, whereas
this sum is of one state, and weighs the steep contacts by what they carry.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.estimate import Estimate
from ..core.limits import LARGEST_FRICTION_ANGLE, MOSTLY_TRUNCATED

#: Strength from the contact itself in one direction: unit, long name, dimensions.
NAMES = {
    "contact_strength": (
        "MPa",
        "shear strength from the contact itself, sum of p tan(phi_b + apparent dip)",
        *("offset", "normal_force"),
    ),
    "contact_strength_grid_error": (
        "MPa",
        "change of it with slopes over twice the spacing, no interval",
        *("offset", "normal_force"),
    ),
    "contact_truncated": (
        "1",
        f"fraction of the force at {LARGEST_FRICTION_ANGLE:g} degrees, where angles are truncated",
        *("offset", "normal_force"),
    ),
    "peak_contact_strength": (
        "MPa",
        "largest shear strength from the contact itself over the offsets",
        "normal_force",
    ),
    "peak_contact_strength_low": (
        "MPa",
        "lower end of it by the change of slopes over twice the spacing",
        "normal_force",
    ),
    "peak_contact_strength_high": ("MPa", "upper end, at most by that angle", "normal_force"),
    "peak_contact_truncated": ("1", "fraction of the force truncated there", "normal_force"),
    "peak_contact_valid": ("1", "at most half of the force is truncated there", "normal_force"),
    "peak_contact_reason": ("1", "why the peak is a lower bound and no result", "normal_force"),
}

#: Reason why a peak is no result.
A_BOUND = f"only a lower bound, as most angles are truncated at {LARGEST_FRICTION_ANGLE:g} degrees"


def friction_of_dips(dips: ArrayLike, basic_friction_angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Shear over normal force of contacts (...) with these dips, and the fraction truncated.

    Dips (..., part) of equal parts of the force and the basic friction angle are in degrees; NaN
    gives NaN. Their sum is truncated at `LARGEST_FRICTION_ANGLE` up and down, as Barton's.
    """
    angle = np.asarray(dips) + basic_friction_angle
    kept = np.clip(angle, -LARGEST_FRICTION_ANGLE, LARGEST_FRICTION_ANGLE)
    truncated = np.where(np.isnan(angle).any(-1), np.nan, (angle != kept).mean(-1))
    return np.tan(np.radians(kept)).mean(-1), truncated


def contact_strength(dips: np.ndarray, pressure: np.ndarray, angle: float) -> dict[str, Any]:
    """:data:`NAMES` of one direction at one resolution.

    Dips (dip_step, offset, load, force_part), degrees, are those of
    :func:`joint.contact_dips.dips_by_force`, NaN of states with few nodes; the second step is for
    the error of the grid. Pressures (load,) are nominal, MPa, the angle is phi_b, degrees.
    """
    ratio, truncated = friction_of_dips(dips, angle)
    tau, twice = ratio * pressure
    error = np.abs(twice - tau)
    place = np.where(np.isnan(tau), -np.inf, tau).argmax(axis=0)
    loads = np.arange(tau.shape[1])
    most = pressure * np.tan(np.radians(LARGEST_FRICTION_ANGLE))
    peak = Estimate.about(tau[place, loads], error[place, loads], 0, most)
    valid = ~(truncated[0][place, loads] > MOSTLY_TRUNCATED)
    return {
        "contact_strength": tau,
        "contact_strength_grid_error": error,
        "contact_truncated": truncated[0],
        **peak.columns("peak_contact_strength"),
        "peak_contact_truncated": truncated[0][place, loads],
        "peak_contact_valid": valid,
        "peak_contact_reason": np.where(valid, "", A_BOUND),
    }
