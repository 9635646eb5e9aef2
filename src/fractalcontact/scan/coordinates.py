"""Coordinates of a matrix in files of their own: x, y and z given as three files."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.units import length_factor
from .confined import read_confined
from .files import regular_file
from .options import ScanOptions

#: Axis of the matrix that each coordinate runs along.
_AXES = {"x": 1, "y": 0}
#: Largest difference of the steps of an even grid, as a fraction of their mean.
UNEVEN = 0.01


def read_coordinates(
    files: Mapping[str, Path], unit: str | None, options: ScanOptions
) -> dict[str, np.ndarray]:
    """Coordinates of the columns (x) and rows (y) of a matrix in mm, ascending or descending.

    Each file of :func:`scan.options.coordinate_files` holds a row or a column of numbers in
    ``unit``, or a matrix, in which x changes along the rows and y from row to row. Numbers without
    a unit, or that are no coordinates of an even grid, are refused.
    """
    coordinates = {}
    for key, path in files.items():
        if unit is None:
            raise InputError(f"{path}: of unknown unit; write 'unit_xy: mm' into the sidecar")
        regular_file(path)
        values = read_confined(path, options).values
        line = _one_line(values, _AXES[key])
        if line is None or len(line) < 2 or not np.isfinite(line).all():
            raise InputError(
                f"{path}: no coordinates {key}: a row or a column of numbers is needed, or a "
                f"matrix in which {key} changes {'along the rows' if key == 'x' else 'by rows'}"
            )
        steps = np.diff(line)
        if not abs(steps.mean()) > 0 or np.ptp(steps) > 2 * UNEVEN * abs(steps.mean()):
            raise InputError(
                f"{path}: {key} goes in steps of {steps.min():.4g} to {steps.max():.4g}; an even "
                "grid is needed, so interpolate it first"
            )
        coordinates[key] = line * length_factor(unit, f"{path}: unit")
    return coordinates


def _one_line(values: np.ndarray, axis: int) -> np.ndarray | None:
    """The coordinate along an axis: of one line of numbers, or a matrix equal along the other."""
    if 1 in values.shape:
        return values.ravel()
    line = np.take(values, 0, axis=1 - axis)
    # Written with few digits, they differ by rounding alone.
    alike = np.ptp(values, axis=1 - axis).max() <= UNEVEN * abs(np.diff(line).mean())
    return line if alike else None
