"""Statements of the paper on dilatancy and contact domains under sliding (Figs. 6 and 7)."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..core.limits import LEVEL_CHANGE, LOOSELY
from ..core.text import compact, number
from ..core.verdicts import FAILS, HOLDS, LEVEL, PARTLY, RISING, UNDETERMINED
from .evidence import Evidence, of_a_kind
from .findings import Finding, Joint, no_offsets, power_of_offset, share

#: Directions in which the paper's concrete has a plateau, and in which it slid.
PLATEAUS, DIRECTIONS = 2, 4


class Plateaus(NamedTuple):
    """Rigid dilatancy over the second half of v, by direction, as the stage ``joints`` has it.

    ``trend`` (n,) has :data:`core.verdicts.LEVEL`, ``RISING`` or ``FALLING``, ``change`` (n,) that
    of the fitted line, a fraction of the mean. ``undecided`` says why the trend of some direction
    does not decide about a plateau; it is empty where all do.
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

    def words(self) -> str:
        """Number of level directions, those that rise, and why there is no verdict."""
        rising = [self.directions[i] for i in np.flatnonzero(self.rising)]
        more = f", rising in {', '.join(rising)}" if rising else ""
        return (
            f"level in {self.flat.sum() or 'none'} of {self.change.size} directions{more}"
            f"{f'; {self.undecided}' if self.undecided else ''}"
        )


@of_a_kind
def dilatancy_flattens(joint: Joint, evidence: Evidence) -> Finding:
    """Change of the rigid dilatancy over the second half of the offsets, in every direction.

    One specimen is judged by the fraction of its directions that are level, realisations by the
    fraction of them that are level in all directions. The claim is undetermined while the faces
    still correlate, as a plateau may yet follow, or those of more than half of the realisations do.
    """
    return _of_plateaus(
        joint,
        evidence,
        asked="all directions",
        met=lambda one: bool(one.flat.all()),
        judged=lambda one: share(int(one.flat.sum()), one.flat.size),
    )


@of_a_kind
def dilatancy_flattens_in_two(joint: Joint, evidence: Evidence) -> Finding:
    """Number of directions with a plateau, and of directions that rise on: two each.

    Realisations are judged by the fraction of them of which this is true. The claim is undetermined
    while the faces still correlate, as a plateau may yet follow.
    """
    if Plateaus.of(joint["joints"]).change.size < DIRECTIONS:
        return Finding(UNDETERMINED, f"{DIRECTIONS} directions needed")
    return _of_plateaus(
        joint,
        evidence,
        asked="two directions and rises in the other two",
        met=lambda one: int(one.flat.sum()) == int(one.rising.sum()) == PLATEAUS,
        judged=_two_each,
    )


def _two_each(plateaus: Plateaus) -> str:
    """Verdict of one joint on two level and two rising directions."""
    flat, rising = int(plateaus.flat.sum()), int(plateaus.rising.sum())
    both = flat > 0 and rising > 0
    return HOLDS if both and flat == rising == PLATEAUS else PARTLY if both else FAILS


def _of_plateaus(
    joint: Joint,
    evidence: Evidence,
    *,
    asked: str,
    met: Callable[[Plateaus], bool],
    judged: Callable[[Plateaus], str],
) -> Finding:
    """Finding on plateaus: of the specimen, or by the fraction of its realisations."""
    own = Plateaus.of(joint["joints"])
    if not own.change.size:
        return Finding(UNDETERMINED, no_offsets("three rigid"))
    note = (
        f"{number(100 * own.change.min(), 0, '+')} to "
        f"{number(100 * own.change.max(), 0, '+')} % change over the second "
        f"half of v; level: up to {compact(100 * LEVEL_CHANGE, 6)} %"
    )
    members = [Plateaus.of(member) for member in evidence.rigid_slides()]
    if not members:
        return Finding(UNDETERMINED if own.undecided else judged(own), own.words(), note)
    decided = [member for member in members if not member.undecided]
    if not decided:
        return Finding(UNDETERMINED, members[0].undecided, note)
    count = sum(met(member) for member in decided)
    # Those few that lose their correlation soon are a selection.
    few = 2 * len(decided) < len(members)
    left = f" that slide far enough, of {len(members)}" if len(decided) < len(members) else ""
    return Finding(
        UNDETERMINED if few else share(count, len(decided)),
        f"level in {asked} in {count or 'none'} of {len(decided)} realisations{left}; "
        f"this specimen: {own.words()}",
        f"this specimen: {note}",
    )


@of_a_kind
def dilatancy_is_anisotropic(joint: Joint, evidence: Evidence) -> Finding:
    """Difference of the changes of the rigid dilatancy among directions, second half of v.

    The changes differ markedly where their range is above 0.25, and in part where it is above 0.2,
    the largest among directions that are all level.
    Realisations are judged by the fraction of them that differ markedly. A tilt of the window opens
    one direction and closes the opposite one by as much; it is that of the window's mean plane.
    """
    own = Plateaus.of(joint["joints"])
    if own.change.size < 2:
        return Finding(UNDETERMINED, "fewer than two directions")
    numbers = (
        f"delta_r changes by {number(100 * own.change.min(), 0, '+')} to "
        f"{number(100 * own.change.max(), 0, '+')} % of "
        "its mean over the second half of v, depending on direction"
    )
    members = evidence.rigid_slides()
    if not members:
        return Finding(_differs(np.ptp(own.change)), numbers, _odd_parts(joint["joints"]))
    ranges = [float(np.ptp(Plateaus.of(member).change)) for member in members]
    marked = sum(_differs(member) == HOLDS for member in ranges)
    return Finding(
        share(marked, len(ranges)),
        f"the directions differ by more than {compact(100 * LOOSELY, 6)} % in "
        f"{marked or 'none'} of "
        f"{len(ranges)} realisations; this specimen: {numbers}",
        _odd_parts(joint["joints"]),
        explanation=f"the recipe is isotropic: {_scatter(members)} is chance of the highest points",
    )


def _odd_parts(joints: xr.Dataset) -> str:
    """Odd part of the slope by axis, and the tilt of the window's mean plane along it."""
    return "; ".join(
        f"{axis}: odd part {number(odd, 3, '+')} v, tilt of the window {number(tilt, 4, '+')}"
        for axis, odd, tilt in zip(
            joints["axis"].values,
            joints["odd_slope"].values,
            joints["window_tilt"].values,
            strict=True,
        )
    )


def _scatter(members: Sequence[xr.Dataset]) -> str:
    """Standard deviation over realisations of the odd parts, by axis, in words."""
    odd = np.array([member["odd_slope"].values for member in members])
    axes = members[0]["axis"].values
    scatter = odd.std(axis=0, ddof=1)
    parts = (f"{number(scatter[i], 3)} v {axis}" for i, axis in enumerate(axes))
    return f"the scatter of the odd part over realisations, {' and '.join(parts)},"


def _differs(spread: float) -> str:
    """Verdict on a claim of markedly different changes."""
    return HOLDS if spread > LOOSELY else PARTLY if spread > 2 * LEVEL_CHANGE else FAILS


def domains_cluster(joint: Joint) -> Finding:
    """Morisita's index of the contact domains against offset, as a power of v."""
    exponent, fitted = joint.localisation
    return power_of_offset("domains_cluster", exponent, fitted, "Morisita's index", rising=True)


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
