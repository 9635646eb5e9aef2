"""Shear strength of the joint from its dilatancy, and Barton and Bandis' law beside it (sect. 5).

The effective friction angle is the basic one plus the dilatancy angle (Goodman 1989, as the paper
has it). Nothing breaks in this model: at small offsets, where the faces climb their steepest
asperities, the sum can pass the vertical, and what is stated as strength is held at
:data:`mechanics.theory.LARGEST_FRICTION_ANGLE` as in Barton's law. What was held is counted.
"""

import numpy as np
import xarray as xr

from ..core.directions import DIRECTIONS
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.mean_plane import without_mean_plane
from ..surface.specimen import faces, nominal_area, window_sides, window_slices
from .joint import direction_spacing, rigid_dilatancy
from .theory import (
    LABORATORY_LENGTH,
    LARGEST_FRICTION_ANGLE,
    barton_strength,
    joint_roughness,
    scaled_joint,
)

#: Residual strength is the mean over the intervals beyond this part of the largest offset.
RESIDUAL_FROM = 0.5

#: Steps over which slopes are taken for Z2, mm, by name; None is the scan's own spacing. Tse &
#: Cruden (1979) state 1.27 mm. Their profiles of 100 mm had 200 such steps, so that they must have
#: been enlarged 2.5 times: a step of 0.508 mm on the rock, kept beside it.
SAMPLINGS = {"scan": None, "0.508 mm": 0.508, "1.27 mm": 1.27}
#: The one that JRC is taken from.
JRC_SAMPLING = "1.27 mm"
#: A window with fewer steps than this along it is called small for its sampling.
FEWEST_STEPS = 10

#: Barton's profiles go from 0 to 20 and his law was measured on them.
JRC_RANGE = (0.0, 20.0)


def from_flush(offset, dilatancy):
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


def dilatancy_angle(offset, dilatancy):
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


def angles_with_errors(offset, dilatancy, error):
    """:func:`dilatancy_angle`, and how far off it may be where the dilatancies are.

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


def slopes_apart(offset, dilatancy, off):
    """Slopes d delta/dv between successive offsets whose ends move apart by ``off``, mm."""
    dilatancy, off = np.asarray(dilatancy, float), np.asarray(off, float)
    step = np.diff(np.asarray(offset, float)).reshape(-1, *[1] * (dilatancy.ndim - 1))
    return (np.diff(dilatancy, axis=0) + off[1:] + off[:-1]) / step


def shear_strength(pressure, friction_angle):
    """tau = sigma_n tan(angle), the angle held between 0 and `LARGEST_FRICTION_ANGLE`.

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
    held : ndarray of int
        1 where the angle was held at the largest, -1 at 0, else 0.
    """
    angle = np.asarray(friction_angle, float)
    held = (angle > LARGEST_FRICTION_ANGLE).astype(int) - (angle < 0)
    angle = np.clip(angle, 0.0, LARGEST_FRICTION_ANGLE)
    return pressure * np.tan(np.radians(angle)), held


def strength_with_error(pressure, friction_angle, off):
    """:func:`shear_strength`, and how far off it may be where the angles are, by ``off`` degrees.

    Returns
    -------
    strength, held
    error : ndarray
        MPa.
    """
    strength, held = shear_strength(pressure, friction_angle)
    ends = [shear_strength(pressure, friction_angle + sign * off)[0] for sign in (-1, 1)]
    return strength, held, abs(np.array(ends) - strength).max(axis=0)


def peak(midpoint, values):
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
    found = np.isfinite(known).any(axis=0)
    highest = np.where(found, known.max(axis=0), np.nan)
    return highest, np.where(found, np.asarray(midpoint)[known.argmax(axis=0)], np.nan)


def residual(midpoint, values, largest):
    """Mean over the intervals beyond `RESIDUAL_FROM` of the largest offset, with its interval.

    Returns
    -------
    mean, low, high, n
        As :func:`core.intervals.mean_interval` has them; with one interval of offsets there
        is no interval of the mean.
    """
    beyond = np.asarray(midpoint) >= RESIDUAL_FROM * largest
    return mean_interval(np.asarray(values, float)[beyond])


def profile_roughness(specimen, direction):
    """Z2 and JRC of the faces under the window, along a direction of sliding.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : {"E", "N", "W", "S"}

    Returns
    -------
    xr.Dataset
        Over `sampling` (:data:`SAMPLINGS`): the `step` made of whole cells (mm), `z2` (rms slope
        over that step, with every place of the first sample; both faces if two were scanned) and
        `jrc` as Tse & Cruden's relation gives it. `jrc_used`, the one of :data:`JRC_SAMPLING` kept
        within :data:`JRC_RANGE`, and `jrc_note`, what is to be known of it.

    Notes
    -----
    Tse & Cruden's relation is a regression over Barton's ten profiles and leaves 0-20 as soon as a
    face is steeper than they are. The law of strength was measured within, and its correction for
    scale has the JRC in exponents, where values beyond make no sense: both get the value kept
    within.
    """
    axis = "yx".index(DIRECTIONS[direction][0])
    spacing = direction_spacing(specimen, direction)
    window = window_slices(specimen)
    levelled = [np.moveaxis(without_mean_plane(z[window]), axis, 0) for z in faces(specimen)]
    cells = len(levelled[0])
    lags = [1 if step is None else max(1, round(step / spacing)) for step in SAMPLINGS.values()]
    z2 = np.array([_rms_slope(levelled, lag, spacing) for lag in lags])
    jrc = np.array([joint_roughness(value) if value > 0 else np.nan for value in z2])
    chosen = list(SAMPLINGS).index(JRC_SAMPLING)
    note = _sampling_note(lags[chosen] * spacing, cells * spacing)
    if not JRC_RANGE[0] <= jrc[chosen] <= JRC_RANGE[1]:
        note.append(f"JRC {jrc[chosen]:.3g} lies outside of Barton's {_range_words()}")
    return xr.Dataset(
        {
            "step": (
                "sampling",
                spacing * np.array(lags),
                cf_attrs("mm", "step of Z2, whole cells"),
            ),
            "z2": ("sampling", z2, cf_attrs("1", "rms slope Z2 of profiles along the sliding")),
            "jrc": ("sampling", jrc, cf_attrs("1", "JRC = 32.2 + 32.47 log10 Z2")),
            "jrc_used": (
                (),
                np.clip(jrc[chosen], *JRC_RANGE),
                cf_attrs("1", f"JRC at {JRC_SAMPLING}, kept within {_range_words()}"),
            ),
            "jrc_note": ((), "; ".join(note), cf_attrs("1", "what is to be known of the JRC used")),
        },
        coords={"sampling": list(SAMPLINGS)},
    )


def _rms_slope(profiles, lag, spacing):
    """Rms slope over a step of ``lag`` cells along the first axis; NaN if it is too long."""
    if lag >= len(profiles[0]):
        return np.nan
    squares = [np.mean((z[lag:] - z[:-lag]) ** 2) for z in profiles]
    return np.sqrt(np.mean(squares)) / (lag * spacing)


def _sampling_note(step, side):
    """Where the step differs from what it should be, or the window is small for it."""
    wanted = SAMPLINGS[JRC_SAMPLING]
    note = []
    if step > 1.25 * wanted:
        note.append(f"the scan's spacing of {step:.3g} mm is coarser than the {wanted:g} mm wanted")
    if side < FEWEST_STEPS * step:
        note.append(f"the window of {side:.3g} mm holds fewer than {FEWEST_STEPS} steps")
    return note


def _range_words():
    return f"{JRC_RANGE[0]:g}-{JRC_RANGE[1]:g}"


def joint_strength(dilatancy, joint, specimen, settings):
    """Dilatancy angle, friction angle and shear strength over the offsets, peak and residual.

    Parameters
    ----------
    dilatancy : xr.Dataset
        From :func:`mechanics.closure.elastic_dilatancy`.
    joint : xr.Dataset
        From :func:`mechanics.joint.describe_joint`.
    specimen : xr.Dataset
        That slides: not one against a plane.
    settings : dict
        From :func:`study.configuration.resolve_settings`; its ``material`` gives
        ``basic_friction_angle`` (degrees) and ``joint_wall_strength`` (JCS, MPa), NaN where the
        study states none, and then what depends on them is NaN.

    Returns
    -------
    xr.Dataset
        Over (contact_direction, interval, load), (contact_direction, load) and
        (contact_direction, sampling): :data:`FIELDS` and :func:`profile_roughness`. What rests on
        solved states has an ``_error``, the solver's. ``interval`` holds midpoints of the offsets
        in the first direction, ``midpoint`` those of each.

    Notes
    -----
    Barton's phi_r is taken as the basic angle (faces that are not weathered), his JRC_0 as that of
    the window: Z2 at a fixed step hardly depends on the length of the profile. His correction for
    scale then goes from `LABORATORY_LENGTH` to the window's own length along the sliding.
    """
    material = settings["material"]
    pressure = dilatancy["load"].values / nominal_area(specimen)
    directions = [str(d) for d in dilatancy["contact_direction"].values]
    parts = [
        _one_direction(dilatancy, joint, specimen, material, direction, pressure)
        for direction in directions
    ]
    result = xr.concat(parts, "contact_direction", join="override", combine_attrs="override")
    result = result.assign_coords(
        contact_direction=directions,
        load=dilatancy["load"],
        interval=("interval", result["midpoint"].values[0], cf_attrs("mm", FIELDS["midpoint"][1])),
    )
    result["nominal_pressure"] = ("load", pressure, cf_attrs("MPa", "nominal pressure sigma_n"))
    for name, units, words in (
        ("basic_friction_angle", "degree", "basic friction angle phi_b"),
        ("joint_wall_strength", "MPa", "joint wall compressive strength JCS"),
    ):
        result[name] = ((), float(material[name]), cf_attrs(units, words))
    return result


_FOUND = {
    "midpoint": ("mm", "middle of the interval of offsets"),
    "dilatancy_angle": ("degree", "dilatancy angle i"),
    "rigid_dilatancy_angle": ("degree", "dilatancy angle of the rigid joint, F = 0"),
    "friction_angle": ("degree", "effective friction angle phi_b + i, not held"),
    "shear_strength": ("MPa", "shear strength tau"),
    "held_high": ("1", f"intervals whose angle was held at {LARGEST_FRICTION_ANGLE:g} degrees"),
    "held_low": ("1", "intervals whose angle was held at 0"),
    "peak_strength": ("MPa", "largest shear strength over the offsets"),
    "peak_offset": ("mm", "offset where it is first reached"),
    "peak_dilatancy_angle": ("degree", "largest dilatancy angle over the offsets"),
    "residual_strength": ("MPa", "mean shear strength beyond half of the largest offset"),
    "residual_strength_low": ("MPa", "residual strength, lower end of the 95 % interval"),
    "residual_strength_high": ("MPa", "residual strength, upper end of the 95 % interval"),
    "residual_angle": ("degree", "mean dilatancy angle beyond half of the largest offset"),
    "residual_angle_low": ("degree", "residual angle, lower end of the 95 % interval"),
    "residual_angle_high": ("degree", "residual angle, upper end of the 95 % interval"),
    "residual_n": ("1", "intervals beyond half of the largest offset"),
    "barton_strength": ("MPa", "peak strength by Barton's law"),
    "scaled_roughness": ("1", "JRC_n for the window's length"),
    "scaled_wall_strength": ("MPa", "JCS_n for the window's length"),
    "barton_scaled_strength": ("MPa", "peak strength by Barton's law with JRC_n and JCS_n"),
}

#: What rests on solved states, and says how far off it may be for that.
_SOLVED = (
    "dilatancy_angle",
    "friction_angle",
    "shear_strength",
    "peak_strength",
    "peak_dilatancy_angle",
)
#: What is found: name to unit and long name.
FIELDS = _FOUND | {
    f"{name}_error": (_FOUND[name][0], f"{_FOUND[name][1]}, error by the solver")
    for name in _SOLVED
}


def _one_direction(dilatancy, joint, specimen, material, direction, pressure):
    """All of :func:`joint_strength` for one direction."""
    angle_b, wall = material["basic_friction_angle"], material["joint_wall_strength"]
    curve = dilatancy.sel(contact_direction=direction)
    offset = curve["offset_made"].values
    elastic = curve["elastic_dilatancy"].transpose("offset", "load").values
    cells = joint["offset_cells"].sel(contact_direction=direction).values
    rigid, _ = rigid_dilatancy(specimen, direction, cells)
    error = curve["elastic_dilatancy_error"].transpose("offset", "load").values
    # Openings of rigid faces are read off the heights.
    errors = np.column_stack([np.zeros_like(rigid), error])
    both = np.column_stack([rigid, elastic])
    largest = offset[-1]
    if specimen.attrs["opposite"] == "match":
        # Flush faces have no dilatancy, whatever the load: no error either.
        _, errors = from_flush(offset, errors)
        offset, both = from_flush(offset, both)
    midpoint, angles, angles_off = angles_with_errors(offset, both, errors)
    rigid_angle, angle, angle_off = angles[:, 0], angles[:, 1:], angles_off[:, 1:]
    tau, held, tau_off = strength_with_error(pressure, angle_b + angle, angle_off)
    stated = np.where(np.isfinite(angle_b), 1.0, np.nan)

    roughness = profile_roughness(specimen, direction)
    jrc = roughness["jrc_used"].item()
    side = window_sides(specimen)["yx".index(DIRECTIONS[direction][0])]
    scaled_jrc, scaled_wall = scaled_joint(jrc, wall, side)
    found = {
        "midpoint": midpoint,
        "dilatancy_angle": angle,
        "rigid_dilatancy_angle": rigid_angle,
        "friction_angle": angle_b + angle,
        "shear_strength": tau,
        "held_high": stated * (held > 0).sum(axis=0),
        "held_low": stated * (held < 0).sum(axis=0),
        "peak_dilatancy_angle": peak(midpoint, angle)[0],
        "barton_strength": barton_strength(pressure, angle_b, jrc, wall),
        "scaled_roughness": scaled_jrc,
        "scaled_wall_strength": scaled_wall,
        "barton_scaled_strength": barton_strength(pressure, angle_b, scaled_jrc, scaled_wall),
    }
    found["peak_strength"], found["peak_offset"] = peak(midpoint, tau)
    # The largest of several values is off by no more than the one that is off most.
    found |= {
        "dilatancy_angle_error": angle_off,
        "friction_angle_error": stated * angle_off,
        "shear_strength_error": tau_off,
        "peak_strength_error": peak(midpoint, tau_off)[0],
        "peak_dilatancy_angle_error": peak(midpoint, angle_off)[0],
    }
    for name, values in (("strength", tau), ("angle", angle)):
        mean, low, high, n = residual(midpoint, values, largest)
        found |= {
            f"residual_{name}": mean,
            f"residual_{name}_low": low,
            f"residual_{name}_high": high,
            "residual_n": n,
        }
    result = roughness.assign(
        {
            name: (_dims(name, values), values, cf_attrs(*FIELDS[name]))
            for name, values in found.items()
        }
    )
    result["scaled_roughness"].attrs["laboratory_length_mm"] = LABORATORY_LENGTH
    return result


def _dims(name, values):
    if name in ("midpoint", "rigid_dilatancy_angle"):
        return ("interval",)
    return {0: (), 1: ("load",), 2: ("interval", "load")}[np.ndim(values)]
