"""Two gridded faces brought together, with the motion of the upper one in numbers and words."""

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.errors import InputError
from ..core.limits import SMALLEST_SIDE
from ..core.mean_plane import without_mean_plane
from ..core.text import percent, plain
from .face_match import LARGEST_ROTATION, for_comparison, mirror_images
from .registration import biweight_limit, biweight_spread, find_motion
from .surface_motion import Motion, Surface, correlation, grid_nodes

#: Least fraction by which a motion lowers the gap's biweight spread: interpolating between cells
#: costs roughness, and the spread is not known better.
SMALLEST_GAIN = 0.01
#: Faces whose match, the correlation without their longest waves, is below the first do not belong
#: together: faces that have nothing to do with each other reach 0.5. The granite pair, a joint
#: that does not close quite, reaches 0.83.
POOR_MATCH, GOOD_MATCH = 0.5, 0.7
#: Fraction of the cells with the upper face below the lower one from which the order of the faces
#: is questioned: an error of the mean gap of two rough faces that touch leaves half of the cells.
MOSTLY_BELOW = 0.9
#: Fraction of the cells that touch or overlap where faces are set down: not a scan's one spike.
_TOUCHING = 0.01
#: A cloud is moved, gridded and matched again until no further tilt of this size is found: one of
#: 0.2 degrees carries a peak sideways by 0.35 % of its height.
_SMALL_TILT = math.tan(math.radians(0.2))
_MAX_PASSES = 4
#: Kind of upper face whose mirror image matches, by the signs of x, y and z.
_IMAGES = {
    (-1, 1, -1): "was scanned on its back: its heights point down and its x runs the other way",
    (1, -1, -1): "was scanned on its back: its heights point down and its y runs the other way",
    (1, 1, -1): "is a cast, or its heights point down",
    (-1, -1, -1): "is a cast, or its heights point down, and it is turned by 180 degrees",
    (-1, -1, 1): "is turned by 180 degrees",
    (-1, 1, 1): "is mirrored: its x runs the other way",
    (1, -1, 1): "is mirrored: its y runs the other way",
}
#: Signs of x, y and z by the sidecar's key `mirror_upper`.
MIRRORS = {None: (1, 1, 1), "x": (-1, 1, -1), "y": (1, -1, -1)}


def register(
    lower: xr.DataArray,
    upper: xr.DataArray,
    mode: str,
    where: str,
    *,
    mirrored: str | None = None,
    regrid: Callable[[Sequence[Motion]], xr.DataArray] | None = None,
) -> tuple[xr.DataArray, xr.DataArray]:
    """Registration of the upper face by the least spread of the gap; both faces are cropped.

    The spread is the biweight one of :mod:`registration.registration`, to which spikes and places
    where rock is lost do not count. Nothing is moved if it would fall by less than 1 %, or if the
    faces do not match. The mean gap is a measurement and stays, so the upper face slides along its
    mean plane. Where the mean gap is not known, because the face was turned over or shares no area
    with the lower one as given, the upper face is set down until 1 % of the cells touch.

    Heights are in mm; the cells of both grids coincide, or are whole cells apart. ``mode`` is
    "rigid", "translation" or "none"; ``mirrored``, x or y, how the upper face was turned over
    before. ``regrid`` grids the upper face anew from its points after a list of motions. Without it
    the face is interpolated between its cells, unless moving it by whole cells does as well.

    Both faces come back on one grid. The upper one has the attribute ``registration``, JSON:
    ``mode``; ``applied``; ``shift_x_mm``, ``shift_y_mm``, ``rotation_degrees`` (from East to
    North), ``tilt_x_degrees``, ``tilt_y_degrees`` (positive where the face rises towards larger x
    or y) of the motion of the upper face, 0 if it was not moved; ``gap_mean_before_mm``,
    ``gap_sd_before_mm``, ``gap_spread_before_mm`` (biweight), ``correlation_before`` (of the
    levelled faces) and the same ``_after``, null where they share no area; ``match``; and in words
    ``note``.

    A mirror image of the upper face that matches where the face itself does not is refused, and
    faces that share no area.
    """
    before = gap_statistics(lower, upper)
    below = "" if mirrored else _upside_down(lower, upper, before, mode, where)
    if mirrored or below:  # the height it was given at means nothing
        before["gap_mean"] = None

    def as_given(note: str, match: float | None = None) -> tuple[xr.DataArray, xr.DataArray]:
        record = _record(mode, None, match, before, before, note + below)
        return _finished(lower, upper, record, where)

    if mode == "none":
        return as_given("not moved, as the sidecar asks")
    motion, found = find_motion(lower, upper, mode)
    match = found["match"]
    if match < POOR_MATCH:
        _refuse_mirror_image(lower, upper, mirrored, where)
        return as_given(
            f"NOTE: the faces do not match (correlation without long waves {match:.2f}, below "
            f"{POOR_MATCH:g}) and are left as they are; faces of one joint match, unless one is "
            f"turned by more than {LARGEST_ROTATION} degrees",
            match,
        )
    moved, motion, how = _moved(lower, upper, motion, mode, regrid)
    moved = moved + _lift(lower, moved, before["gap_mean"])
    after = gap_statistics(lower, moved)
    earlier, later = _spreads(lower, upper, moved)
    gain = 1 - later / earlier if earlier and later is not None else 0.0
    if earlier is not None and gain < SMALLEST_GAIN:
        return as_given(
            f"not moved: the best motion lowers the spread of the gap by {100 * max(gain, 0):.2g} "
            f"%, less than {100 * SMALLEST_GAIN:g} %",
            match,
        )
    note = f"upper face moved {how}"
    if before["gap_mean"] is None:
        note += "; its height is not known, so it is lowered until 1 % of the cells touch"
    if not found["converged"]:
        note += "; NOTE: the search had not come to rest"
    moved.attrs = upper.attrs
    return _finished(lower, moved, _record(mode, motion, match, before, after, note + below), where)


def _upside_down(lower, upper, before: dict, mode: str, where: str) -> str:
    """Name faces of which the upper one lies below the lower one nearly everywhere.

    Faces given in one coordinate frame are in the wrong order. Heights of faces scanned in frames
    of their own may also have no common zero.
    """
    gap = None if before["gap_mean"] is None else _common_gap(lower, upper)
    if gap is None:
        return ""
    fraction = float((gap[np.isfinite(gap)] < 0).mean())
    if fraction < MOSTLY_BELOW:
        return ""
    found = (
        f"the upper face lies below the lower one in {percent(fraction)} of the cells, by "
        f"{plain(-before['gap_mean'])} mm on average"
    )
    if mode == "none":
        raise InputError(
            f"{where}: {found}, so they are in the wrong order, or not in one frame as "
            "'registration: none' states; exchange 'lower' and 'upper' in the names of the files, "
            "or remove that key"
        )
    return (
        f"; NOTE: as given {found}: if the files are in the wrong order, exchange 'lower' and "
        "'upper' in their names; if only their heights have no common zero, ignore this note"
    )


def gap_statistics(lower: xr.DataArray, upper: xr.DataArray) -> dict:
    """Mean and spread of the gap in mm and correlation of the levelled faces.

    All are None where the faces share less than 8 x 8 cells: there is no gap to speak of.
    """
    pair, gap = _common_rectangle(lower, upper), _common_gap(lower, upper)
    if pair is None or gap is None:
        return dict.fromkeys(("gap_mean", "gap_sd", "gap_spread", "correlation"))
    both = np.isfinite(gap)
    levelled = [without_mean_plane(np.where(both, face.values, np.nan)) for face in pair]
    return {
        "gap_mean": float(gap[both].mean()),
        "gap_sd": float(gap[both].std()),
        "gap_spread": biweight_spread(gap, biweight_limit(gap)),
        "correlation": correlation(*levelled),
    }


def _common_gap(lower, upper) -> np.ndarray | None:
    """Gap over the rectangle that both faces cover; None with too few cells."""
    pair = _common_rectangle(lower, upper)
    gap = None if pair is None else pair[1].values - pair[0].values
    return None if gap is None or np.isfinite(gap).sum() < SMALLEST_SIDE**2 else gap


def _spreads(lower, first, second) -> list[float | None]:
    """Biweight spreads of two gaps by one limit, mm; None without a gap."""
    gaps = [_common_gap(lower, face) for face in (first, second)]
    limit = max((biweight_limit(gap) for gap in gaps if gap is not None), default=np.inf)
    return [None if gap is None else biweight_spread(gap, limit) for gap in gaps]


def crop_to_common(
    lower: xr.DataArray, upper: xr.DataArray, where: str
) -> tuple[xr.DataArray, xr.DataArray]:
    """Both faces cropped to their common rectangle, where their cells coincide.

    A rectangle of fewer than 8 cells along a side is refused.
    """
    pair = _common_rectangle(lower, upper)
    if pair is None:
        raise InputError(
            f"{where}: the faces share no area of {SMALLEST_SIDE} x {SMALLEST_SIDE} cells; give "
            "both in one coordinate frame, and write 'registration: none' only if they are"
        )
    return pair


def _common_rectangle(lower, upper):
    """Both faces on the rectangle of cells they share, None if it is too small."""
    for axis in "xy":
        shift = round(float(upper[axis][0] - lower[axis][0]) / lower.attrs[f"spacing_{axis}"])
        start, stop = max(0, shift), min(lower.sizes[axis], upper.sizes[axis] + shift)
        if stop - start < SMALLEST_SIDE:
            return None
        lower = lower.isel({axis: slice(start, stop)})
        upper = upper.isel({axis: slice(start - shift, stop - shift)})
    return lower, upper.assign_coords(x=lower.x, y=lower.y)


def _moved(lower, upper, motion, mode, regrid):
    """Upper face after the motion except for its height, the motion, and its description."""
    if regrid is not None:
        moved, motion = _move_points(lower, motion, mode, regrid)
        return moved, motion, "before its points were gridded"
    moved = lower.copy(data=Surface(upper)(*motion.back(*grid_nodes(lower))))
    moved = _tilted(moved, motion)
    by_cells, cell_motion = _move_by_cells(upper, motion)
    spread, spread_by_cells = _spreads(lower, moved, by_cells)
    if None not in (spread, spread_by_cells) and spread_by_cells * (1 - SMALLEST_GAIN) <= spread:
        return by_cells, cell_motion, "by whole cells"
    return moved, motion, "and interpolated between its cells by a cubic spline"


def _move_by_cells(upper, motion: Motion):
    """The nearest motion that needs no interpolation: whole cells, and the tilt."""
    steps = [
        upper.attrs[f"spacing_{axis}"] * round(shift / upper.attrs[f"spacing_{axis}"])
        for axis, shift in zip("xy", motion.shift, strict=True)
    ]
    end = (motion.start[0] + steps[0], motion.start[1] + steps[1])
    motion = replace(motion, end=end, rotation=0.0)
    moved = upper.assign_coords(x=upper.x + steps[0], y=upper.y + steps[1])
    return _tilted(moved, motion), motion


def _move_points(lower, motion, mode, regrid):
    """Move the points and grid them, with a second pass where a tilt moved peaks sideways."""
    motions, total = [motion], motion
    for _ in range(_MAX_PASSES):
        moved = regrid(motions)
        if math.hypot(*motion.slope) < _SMALL_TILT:
            break
        motion, _ = find_motion(lower, moved, mode)
        motions.append(motion)
        total = total.then(motion)
    else:
        moved = regrid(motions)
    return moved, total


def _tilted(heights, motion):
    return heights + motion.rise(*grid_nodes(heights))


def _lift(lower, moved, mean_gap) -> float:
    """Shift that restores the mean gap, or makes the faces touch where it is unknown."""
    lower, moved = _common_rectangle(lower, moved)
    gap = moved.values - lower.values
    if mean_gap is None:
        return -float(np.nanquantile(gap, _TOUCHING))
    return mean_gap - float(np.nanmean(gap))


def _refuse_mirror_image(lower, upper, mirrored, where) -> None:
    """Raise if the upper face does not match but a mirror image of it does."""
    matches = mirror_images(*for_comparison(lower, upper))
    signs = max(matches, key=lambda image: matches[image])
    if matches[signs] < GOOD_MATCH:
        return
    total = tuple(a * b for a, b in zip(signs, MIRRORS[mirrored], strict=True))
    remedies = {
        MIRRORS[None]: "remove 'mirror_upper' from the sidecar",
        MIRRORS["x"]: "write 'mirror_upper: x' in the sidecar",
        MIRRORS["y"]: "write 'mirror_upper: y' in the sidecar",
    }
    reversed_axes = " and ".join(axis for axis, sign in zip("xyz", total, strict=True) if sign < 0)
    remedy = remedies.get(total, f"change the sense of {reversed_axes} in its file")
    if mirrored and total not in remedies:
        remedy += " and remove 'mirror_upper'"
    seen = f", with 'mirror_upper: {mirrored}'," if mirrored else ""
    raise InputError(
        f"{where}: the upper face{seen} {_IMAGES[signs]} (a correlation of {matches[signs]:.2f} "
        f"says so, as it stands there is none); {remedy}"
    )


def _record(mode, motion, match, before, after, note) -> dict:
    made = motion or Motion()
    return {
        "mode": mode,
        "applied": motion is not None,
        "shift_x_mm": made.shift[0],
        "shift_y_mm": made.shift[1],
        "rotation_degrees": math.degrees(made.rotation),
        "tilt_x_degrees": math.degrees(math.atan(made.slope[0])),
        "tilt_y_degrees": math.degrees(math.atan(made.slope[1])),
        "gap_mean_before_mm": before["gap_mean"],
        "gap_mean_after_mm": after["gap_mean"],
        "gap_sd_before_mm": before["gap_sd"],
        "gap_sd_after_mm": after["gap_sd"],
        "gap_spread_before_mm": before["gap_spread"],
        "gap_spread_after_mm": after["gap_spread"],
        "correlation_before": before["correlation"],
        "correlation_after": after["correlation"],
        "match": match,
        "note": note,
    }


def _finished(lower, upper, record, where):
    lower, upper = (
        face.assign_attrs(missing_share=float(face.isnull().mean()))
        for face in crop_to_common(lower, upper, where)
    )
    return lower, upper.assign_attrs(registration=json.dumps(record))
