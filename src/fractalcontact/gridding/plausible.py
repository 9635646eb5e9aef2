"""Plausibility of gridded heights: what no rough surface has is refused or noted in a sentence.

Refused are sizes and units that no scan has, constants and coordinates. Noted are profiles drawn
out, planes, two tables in one file and many missing cells, which are mostly wrong but need not be.
"""

import math
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.limits import SMALLEST_SIDE
from ..core.mean_plane import without_mean_plane
from ..core.text import percent

LARGEST_FIELD = 1e4  # mm: no profilometer sees 10 m
SMALLEST_FIELD = 1e-6  # mm: nor less than 1 nm
SMALLEST_SPACING = 1e-7  # mm: an atom
LARGEST_ASPECT = 100  # of the two spacings of a cell
#: Degrees of tilt beyond which heights over x and y are no picture of a face any more.
STEEPEST = 80.0
CONSTANT = 1e-12  # relative: what interpolating a constant surface leaves
#: Largest relief, as a fraction of the heights, that arithmetic or the seven digits of single
#: precision leave of an exact plane.
_PLANE = 1e-6
#: Fraction of missing cells above which the user is warned.
MANY_MISSING = 0.5
#: Least difference of the two rows at a seam, in median differences of neighbouring rows.
_SEAM = 10.0
#: Least difference of the two rows at a seam, in units of the next largest difference: relief has
#: no single cut right across.
_NEXT = 3.0
#: Fewest cells with heights in both rows that show a seam.
_MIN_IN_ROW = 8
#: Cells of a row that are compared across a seam, spread over the row.
_SAMPLE = 500


def check_surface(heights: np.ndarray, spacing: tuple[float, float], path: Path) -> list[str]:
    """Warnings on gridded heights (ny, nx) in mm, NaN where missing, with cells dx, dy in mm.

    Heights that cannot be those of a rough surface are refused: too few, constant, coordinates, or
    of a size that no scan has.
    """
    if min(heights.shape) < SMALLEST_SIDE:
        raise InputError(
            f"{path}: {heights.shape[1]} x {heights.shape[0]} cells (x, y) are too few; at least "
            f"{SMALLEST_SIDE} x {SMALLEST_SIDE} are needed"
        )
    present = heights[np.isfinite(heights)]
    if present.size == 0:
        raise InputError(f"{path}: all cells are missing")
    if np.ptp(present) <= CONSTANT * np.abs(present).max():
        raise InputError(
            f"{path}: a constant surface: every height is {present[0]:g} mm, so this is no scan"
        )
    check_spacing(spacing, path)
    profile = _profile_words(heights, path)
    levelled = without_mean_plane(heights)
    _refuse_size(heights, levelled, spacing, path)
    words = []
    missing = float(np.isnan(heights).mean())
    if missing > MANY_MISSING:
        words.append(
            f"{percent(missing)} of the cells are missing; look at the file in the program that "
            "wrote it, and check 'missing' and the columns in the sidecar"
        )
    residual = levelled[np.isfinite(levelled)]
    if profile:
        words += profile
    elif residual.size and np.ptp(residual) <= _PLANE * np.ptp(present):
        words.append(
            "all heights lie on one plane to within rounding: this file has no roughness, and "
            "results on it would be rounding errors"
        )
    else:
        words += _seam_words(heights)
    return words


def check_spacing(spacing: tuple[float, float], path: Path) -> None:
    """Refuse cells dx, dy in mm that no instrument measures.

    Refused is a side that is no length above zero, is less than an atom, or is more than
    `LARGEST_ASPECT` times the other.
    """
    dx, dy = spacing
    cells = f"{path}: cells of {dx:.4g} x {dy:.4g} mm are not plausible"
    if not all(math.isfinite(step) and step > 0 for step in spacing):
        reason = "a spacing is a length above zero; write it in the sidecar, 'spacing: 0.1 mm'"
    elif min(spacing) < SMALLEST_SPACING:
        reason = (
            f"{min(spacing):.3g} mm is less than an atom ({SMALLEST_SPACING:g} mm), so the unit or "
            "the spacing is wrong; "
            "write the right one in the sidecar, 'unit_xy: um' or 'spacing: 0.5 um'"
        )
    elif max(spacing) > LARGEST_ASPECT * min(spacing):
        reason = (
            f"one side is more than {LARGEST_ASPECT} times the other; write both in the sidecar, "
            "'spacing: [0.1 mm, 0.2 mm]'"
        )
    else:
        return
    raise InputError(f"{cells}: {reason}")


def _refuse_size(heights, levelled, spacing: tuple[float, float], path: Path) -> None:
    """Refuse a field too large or too small, or a relief higher than the field is wide.

    The relief is that above the mean plane: a steep mounting makes no unit wrong.
    """
    field = max(n * step for n, step in zip(heights.shape[::-1], spacing, strict=True))
    remedy = (
        "its unit or spacing is wrong; write the right ones in the sidecar, 'unit: um' (or "
        "'unit_xy' and 'unit_z') and, for a matrix, 'spacing: 0.5 um'"
    )
    if not SMALLEST_FIELD <= field <= LARGEST_FIELD:
        raise InputError(
            f"{path}: a field of {field:.4g} mm is not plausible (from {SMALLEST_FIELD:g} to "
            f"{LARGEST_FIELD:g} mm are): {remedy}"
        )
    if not np.isfinite(levelled).any():  # one line of cells alone
        levelled = heights
    present = np.isfinite(levelled)
    low, high = np.percentile(levelled[present], [1, 99])  # a few spikes do not make a unit wrong
    if high - low > field:
        raise InputError(
            f"{path}: a field of {field:.4g} mm with a relief of {high - low:.4g} mm above its "
            f"mean plane, more than the field is wide, is not plausible: {remedy}"
        )
    low, high = np.percentile((heights - levelled)[present], [1, 99])
    if (rise := math.degrees(math.atan2(high - low, field))) > STEEPEST:
        raise InputError(
            f"{path}: the mean plane rises by {high - low:.4g} mm over a field of {field:.4g} mm, "
            f"{rise:.0f} degrees, where at most {STEEPEST:g} are read: turn the scan level, or "
            f"{remedy}"
        )


def _profile_words(heights: np.ndarray, path: Path) -> list[str]:
    """Sentence on heights that are alike along one axis; along the other, coordinates rise."""
    for along, across, z in (("y", "x", heights), ("x", "y", heights.T)):
        profile = _common_profile(z)
        if profile is None:
            continue
        rises = np.diff(profile[np.isfinite(profile)])
        if (rises > 0).all() or (rises < 0).all():
            raise InputError(
                f"{path}: all heights are equal along {along} and rise or fall steadily along "
                f"{across}: these are coordinates or a bare slope, no rough surface; name the "
                "array or the columns of the heights in the sidecar ('variable', 'columns')"
            )
        return [
            f"every height is the same all along {along}: a profile drawn out, not a scanned "
            "surface"
        ]
    return []


def _common_profile(z: np.ndarray) -> np.ndarray | None:
    """The row that all rows repeat, None if they differ."""
    present = np.isfinite(z)
    low = np.where(present, z, np.inf).min(axis=0)
    high = np.where(present, z, -np.inf).max(axis=0)
    if (present.sum(axis=0) < 2).any() or not np.array_equal(low, high):
        return None
    return low


def _seam_words(heights: np.ndarray) -> list[str]:
    """Sentence on each axis along which all heights change at once."""
    words = []
    for line, z in (("rows", heights), ("columns", heights.T)):
        if (seam := _seam(z)) is not None:
            place, factor = seam
            words.append(
                f"{line} {place} and {place + 1} differ {factor:.0f} times as much as neighbouring "
                f"{line} usually do, all along: two tables in one file, or two scans side by "
                "side? Cut them apart"
            )
    return words


def _seam(z: np.ndarray) -> tuple[int, float] | None:
    """The row after which all heights change at once, and how much more than elsewhere."""
    z = z[:, :: max(1, z.shape[1] // _SAMPLE)]
    steps = np.abs(np.diff(z, axis=0))
    is_measured = np.isfinite(steps).sum(axis=1) >= _MIN_IN_ROW
    if is_measured.sum() < _MIN_IN_ROW:
        return None
    # The lower quartile along the row: nearly all cells must take part.
    size = np.zeros(len(steps))
    size[is_measured] = np.nanquantile(steps[is_measured], 0.25, axis=1)
    usual = float(np.median(size[is_measured]))
    first = int(np.argmax(size))
    next_most = float(np.delete(size, first).max())
    if usual == 0 or size[first] < max(_SEAM * usual, _NEXT * next_most):
        return None
    return first + 1, float(size[first] / usual)
