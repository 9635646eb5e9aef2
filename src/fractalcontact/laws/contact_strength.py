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
from ..core.intervals import t_quantile
from ..core.limits import LARGEST_FRICTION_ANGLE, MOSTLY_TRUNCATED

_BOUNDS = (-LARGEST_FRICTION_ANGLE, LARGEST_FRICTION_ANGLE)

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
    "contact_strength_sampling_error": (
        "MPa",
        "error of it over realisations, by the number of contacts and the amplitude of the long "
        "waves, half-width at 95 %",
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
        "lower end of it by the change of slopes over twice the spacing and over realisations",
        "normal_force",
    ),
    "peak_contact_strength_high": ("MPa", "upper end, at most by that angle", "normal_force"),
    "peak_contact_truncated": ("1", "fraction of the force truncated there", "normal_force"),
    "peak_contact_valid": ("1", "at most half of the force is truncated there", "normal_force"),
    "peak_contact_reason": ("1", "why the peak is a lower bound and no result", "normal_force"),
}

#: What the error over realisations follows from: unit, long name.
SAMPLED_BY = {
    "contact_clusters": ("1", "contact clusters, neighbours by side or corner"),
    "amplitude_error": ("1", "relative standard deviation of the rms height over windows"),
}
#: Factor on the error by the number of contacts, which are neither equal nor independent: with it
#: and the amplitude 96 to 100 % of 24 seeds were covered (elastic and crushing, with roll-off), 54
#: and 71 % without a roll-off.
OF_CONTACTS = 1.3

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


def sampling_error(
    dips: np.ndarray,
    clusters: np.ndarray,
    amplitude: np.ndarray | float,
    pressure: np.ndarray,
    angle: float,
) -> np.ndarray:
    """Error of the strength over realisations (offset, load), half-width at 95 %, MPa.

    Contacts are as many draws of tan(phi_b + dip) as there are clusters; and what the dips add to
    the basic friction grows with the amplitude of the waves, which the window holds few of.
    """
    friction = np.tan(np.radians(np.clip(dips + angle, *_BOUNDS)))
    by_count = OF_CONTACTS * friction.std(-1) / np.sqrt(np.maximum(clusters, 1))
    above = np.maximum(friction.mean(-1) - np.tan(np.radians(angle)), 0)
    by_amplitude = amplitude * above
    return t_quantile(np.inf) * pressure * np.hypot(by_count, by_amplitude)


def contact_strength(
    dips: np.ndarray,
    contact_clusters: np.ndarray,
    amplitude_error: np.ndarray | float,
    *,
    pressure: np.ndarray,
    angle: float,
) -> dict[str, Any]:
    """:data:`NAMES` of one direction at one resolution.

    Dips (dip_step, offset, load, force_part), degrees, are those of
    :func:`joint.contact_dips.dips_by_force`, NaN of states with few nodes; the second step is for
    the error of the grid. ``contact_clusters`` (offset, load) and ``amplitude_error`` are those of
    :data:`SAMPLED_BY`. Pressures (load,) are nominal, MPa, the angle is phi_b, degrees.
    """
    ratio, truncated = friction_of_dips(dips, angle)
    tau, twice = ratio * pressure
    error = np.abs(twice - tau)
    place = np.where(np.isnan(tau), -np.inf, tau).argmax(axis=0)
    loads = np.arange(tau.shape[1])
    most = pressure * np.tan(np.radians(LARGEST_FRICTION_ANGLE))
    sampling = sampling_error(dips[0], contact_clusters, amplitude_error, pressure, angle)
    both = np.hypot(error, sampling)
    peak = Estimate.about(tau[place, loads], both[place, loads], 0, most)
    valid = ~(truncated[0][place, loads] > MOSTLY_TRUNCATED)
    return {
        "contact_strength": tau,
        "contact_strength_grid_error": error,
        "contact_strength_sampling_error": sampling,
        "contact_truncated": truncated[0],
        **peak.columns("peak_contact_strength"),
        "peak_contact_truncated": truncated[0][place, loads],
        "peak_contact_valid": valid,
        "peak_contact_reason": np.where(valid, "", A_BOUND),
    }
