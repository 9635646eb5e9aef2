"""Sentences that stand wherever a quantity is published."""

import math

from ..core.text import short


def aperture_caveat(shifted_ratio: float) -> str:
    """Sentence beside every transmissivity and hydraulic aperture.

    Parameters
    ----------
    shifted_ratio : float
        ``shifted_ratio`` of the stage ``flow``; NaN where nothing flows.
    """
    tested = "Closure and stiffness were compared with tests, the absolute aperture was not"
    if not math.isfinite(shifted_ratio):
        return f"{tested}."
    times = short(shifted_ratio, 2)
    return f"{tested}: faces fitted 0.1 mm too far apart let {times} times as much pass."
