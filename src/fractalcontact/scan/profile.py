"""Profiles: heights along a line, of a table whose two columns are named x and z with units."""

import re
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.units import length_factor
from .text_lines import open_text

_NAMED = re.compile(r"([xz])\s*[\[(]\s*([^\])]+?)\s*[\])]", re.IGNORECASE)
#: Steps may differ from their mean by this part of it.
_EVEN = 0.01


def read_profile(path: Path | str) -> tuple[np.ndarray, float]:
    """Heights of a profile in even steps.

    Parameters
    ----------
    path : path-like
        Text: a line such as ``x [mm], z [um]``, then numbers, x ascending in even steps.

    Returns
    -------
    heights : (n,) ndarray
        mm.
    spacing : float
        mm.

    Raises
    ------
    InputError
        If it is a spreadsheet, names no columns or units, or its x do not rise in even steps.
    """
    path = Path(path)
    if path.suffix.lower() in (".xls", ".xlsx", ".ods"):
        raise InputError(f"{path}: a spreadsheet; save the sheet as CSV")
    try:
        with open_text(path) as file:
            lines = [line.strip() for line in file if line.strip()]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error}); expected a text file") from None
    cells = re.split(r"[,;\t]", lines[0].lstrip("#% ")) if lines else []
    named = [_NAMED.fullmatch(cell.strip().strip("\"'")) for cell in cells]
    axes = [match[1].lower() if match else "" for match in named]
    if sorted(axes) != ["x", "z"]:
        raise InputError(
            f"{path}: the first line does not name two columns; expected their names and units, "
            "such as 'x [mm], z [um]', and two numbers in every other line"
        )
    factors = [length_factor(m[2], f"{path}: column {m[1]}") for m in named if m]
    try:
        table = np.array([[float(one) for one in re.split(r"[,;\t]", row)] for row in lines[1:]])
        numbers = table.reshape(-1, 2) * factors
    except ValueError:
        raise InputError(
            f"{path}: a line does not hold two numbers; write numbers with a decimal point and "
            "the same delimiter as in the first line"
        ) from None
    x, z = numbers[:, axes.index("x")], numbers[:, axes.index("z")]
    steps = np.diff(x)
    even = x.size > 1 and steps.min() > 0 and np.ptp(steps) <= 2 * _EVEN * steps.mean()
    if not np.isfinite(numbers).all() or not even:
        raise InputError(
            f"{path}: x does not rise in even steps (within {100 * _EVEN:.0f} %), or a number is "
            "not finite; resample the profile to even steps and fill its gaps"
        )
    return z, float(steps.mean())
