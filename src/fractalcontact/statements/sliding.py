"""Statements of the paper on dilatancy and contact domains under sliding (Figs. 6 and 7)."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from ..core.limits import LEVEL_CHANGE, LOOSELY, NEARLY
from ..core.text import compact, number
from ..core.verdicts import FAILS, HOLDS, LEVEL, PARTLY, RISING, UNDETERMINED
from .findings import Finding, Joint, no_offsets, power_of_offset, share

#: Directions in which the paper's concrete has a plateau, of those it slid in.
PLATEAUS, DIRECTIONS = 2, 4


class Plateaus(NamedTuple):
    """Rigid dilatancy over the second half of v, by direction, as the stage ``joints`` has it.

    Attributes
    ----------
    directions : list of str
    trend : (n,) ndarray of str
        :data:`core.verdicts.LEVEL`, ``RISING`` or ``FALLING``.
    change : (n,) ndarray
        Of the fitted line, a fraction of the mean.
    undecided : str
        Why the trend of some direction says nothing of a plateau; empty where all do.
    """

    directions: list[str]
    trend: np.ndarray
    change: np.ndarray
    undecided: str

    @classmethod
    def of(cls, joints: xr.Dataset) -> "Plateaus":
        """Trends of the stage ``joints``; directions without a line are left out."""
        fitted = joints.sel(direction=np.isfinite(joints["plateau_slope"].values))
        return cls(
            [str(name) for name in fitted["direction"].values],
            fitted["plateau_trend"].values.astype(str),
            fitted["plateau_change"].values,
            next(filter(None, fitted["plateau_undecided"].values.tolist()), ""),
        )

    @property
    def flat(self) -> np.ndarray:
        """Directions with a plateau."""
        return self.trend == LEVEL

    @property
    def rising(self) -> np.ndarray:
        """Directions in which dilatancy keeps rising."""
        return self.trend == RISING

    def finding(self, verdict: str) -> Finding:
        """Verdict with the number of level directions and their change; undetermined if one is."""
        rising = [self.directions[i] for i in np.flatnonzero(self.rising)]
        more = f", rising in {', '.join(rising)}" if rising else ""
        return Finding(
            UNDETERMINED if self.undecided else verdict,
            f"level in {self.flat.sum() or 'none'} of {self.change.size} directions{more}"
            f"{f'; {self.undecided}' if self.undecided else ''}",
            f"{number(100 * self.change.min(), 0, '+')} to "
            f"{number(100 * self.change.max(), 0, '+')} % change over the "
            f"second half of v; level: up to {compact(100 * LEVEL_CHANGE, 6)} %",
        )


def dilatancy_flattens(joint: Joint) -> Finding:
    """Change of the rigid dilatancy over the second half of the offsets, in every direction.

    The claim is undetermined while the faces still correlate, as a plateau may yet follow.
    """
    plateaus = Plateaus.of(joint["joints"])
    if not plateaus.change.size:
        return Finding(UNDETERMINED, no_offsets("three rigid"))
    return plateaus.finding(share(int(plateaus.flat.sum()), plateaus.flat.size))


def dilatancy_flattens_in_two(joint: Joint) -> Finding:
    """Number of directions with a plateau, and of directions that rise on: two each.

    The claim is undetermined while the faces still correlate, as a plateau may yet follow.
    """
    plateaus = Plateaus.of(joint["joints"])
    if plateaus.change.size < DIRECTIONS:
        return Finding(UNDETERMINED, f"{DIRECTIONS} directions needed")
    flat, rising = int(plateaus.flat.sum()), int(plateaus.rising.sum())
    both = flat > 0 and rising > 0
    verdict = HOLDS if both and flat == rising == PLATEAUS else PARTLY if both else FAILS
    return plateaus.finding(verdict)


def dilatancy_is_anisotropic(joint: Joint) -> Finding:
    """Difference of the slopes of the rigid dilatancy among directions, second half of v.

    A tilt of the window raises the slope in one direction and lowers it in the opposite one by as
    much. The mean of both is roughness alone. Where the two axes have the same mean, the claim
    holds in part.
    """
    joints = joint["joints"]
    change = Plateaus.of(joints).change
    if change.size < 2:
        return Finding(UNDETERMINED, "fewer than two directions")
    verdict = _differs(np.ptp(change))
    even, tilts = joints["even_change"].values, joints["odd_slope"].values
    axes = [str(axis) for axis in joints["axis"].values]
    parts = "; ".join(
        f"{axis} {number(100 * rise, 0, '+')} % in the mean of both directions, tilt "
        f"{number(tilt, 3, '+')} v"
        for axis, rise, tilt in zip(axes, even, tilts, strict=True)
    )
    if len(axes) > 1 and verdict == HOLDS and _differs(np.ptp(even)) != HOLDS:
        verdict = PARTLY
    return Finding(
        verdict,
        f"delta_r changes by {number(100 * change.min(), 0, '+')} to "
        f"{number(100 * change.max(), 0, '+')} % of its mean "
        "over the second half of v, depending on direction",
        parts,
    )


def _differs(spread: float) -> str:
    """Verdict on a claim of markedly different changes."""
    return HOLDS if spread > LOOSELY else PARTLY if spread > NEARLY else FAILS


def domains_cluster(joint: Joint) -> Finding:
    """Morisita's index of the contact domains against offset, as a power of v."""
    exponent, fitted = joint.localisation
    return power_of_offset(exponent, fitted, "Morisita's index", rising=True)


def no_correlation_is_left(joint: Joint) -> Finding:
    """Correlation of the faces at the largest offset solved."""
    limit = float(joint["joints"]["correlation_limit"])
    v = joint["joints"]["rigid_offset"].values
    correlation = joint.of_direction("face_correlation")[np.argmin(np.abs(v - joint.offsets[-1]))]
    numbers, where = (
        f"correlation {number(correlation, 2, '+')}",
        f"at v = {compact(joint.offsets[-1])} mm",
    )
    if not np.isfinite(limit):
        too_small = "in so small a window chance may give as much"
        return Finding(UNDETERMINED, numbers, f"{where}; {too_small}")
    verdict = HOLDS if correlation <= limit else FAILS
    return Finding(verdict, f"{numbers}; chance gives up to {number(limit)}", where)
