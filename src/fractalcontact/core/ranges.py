"""Closed ranges, with a tolerance for rounding."""

from typing import Any

import numpy as np

#: Relative rounding error of spacings, box sizes and loads, which are products.
RELATIVE_ROUNDING = 1e-9


def in_cells(lengths: tuple[float, float] | None, spacing: float) -> tuple[float, float]:
    """Range of lengths in mm as one in cells of side ``spacing``, mm; without one, all lengths."""
    return (0.0, np.inf) if lengths is None else (lengths[0] / spacing, lengths[1] / spacing)


def within(values: Any, low: Any, high: Any) -> Any:
    """Mask of positive values in a range, ends included within rounding; False where NaN.

    The ends are positive, or 0 and infinity. The mask has the kind and shape of the values.
    """
    values = values if hasattr(values, "dims") else np.asarray(values)
    return (values >= low * (1 - RELATIVE_ROUNDING)) & (values <= high * (1 + RELATIVE_ROUNDING))
