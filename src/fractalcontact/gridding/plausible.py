"""Sizes that no scan of a rough surface has: a wrong unit, nearly always."""

import math
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.mean_plane import without_mean_plane

LARGEST_FIELD = 1e4  # mm: no profilometer sees 10 m
SMALLEST_FIELD = 1e-6  # mm: nor less than 1 nm
SMALLEST_SPACING = 1e-7  # mm: an atom
LARGEST_ASPECT = 100  # of the two spacings of a cell
#: Degrees of tilt beyond which heights over x and y are no picture of a face any more.
STEEPEST = 80.0


def check_spacing(spacing: tuple[float, float], path: Path) -> None:
    """Refuse cells that no instrument measures.

    Parameters
    ----------
    spacing : (float, float)
        dx, dy in mm.
    path : Path

    Raises
    ------
    InputError
        If a spacing is no length above zero, below the size of an atom, or more than
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


def check_relief(heights: np.ndarray, spacing: tuple[float, float], path: Path) -> None:
    """Refuse a field too large or too small, or a relief higher than the field is wide.

    The relief is that above the mean plane: a steep mounting makes no unit wrong.

    Parameters
    ----------
    heights : (ny, nx) ndarray
        In mm, NaN where missing.
    spacing : (float, float)
        dx, dy in mm.
    path : Path

    Raises
    ------
    InputError
        With what to write in the sidecar.
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
    levelled = without_mean_plane(heights)
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
