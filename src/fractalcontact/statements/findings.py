"""Judging of a statement: the joint's stages, verdicts, and rules that several share."""

from collections.abc import Callable
from functools import cached_property, wraps
from typing import NamedTuple

import numpy as np

from ..core.claims import all_claims
from ..core.estimate import Estimate, names_of
from ..core.fitting import MIN_POINTS, fit_line
from ..core.limits import RESOLVED_NODES
from ..core.subject import Subject
from ..core.text import compact, loads_of, number
from ..core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED

#: Why a joint under a hardness may be asked nothing of its contact area.
BY_CONSTRUCTION = "A_r = F/H, because all contacts yield"


class Finding(NamedTuple):
    """Verdict on one statement, its numbers, and a remark.

    Captions quote the verdict and the numbers. The note stands in the table alone, and so does
    ``judged_on``, which is empty where the whole subject was judged.
    """

    verdict: str
    numbers: str
    note: str = ""
    judged_on: str = ""


class Joint(Subject):
    """Joint, with quantities that several statements use.

    It has the stages ``specimens``, ``joints``, ``closure``, ``dilatancy``, ``area``, ``windows``,
    ``domains``, ``scaling``, ``domain_measures`` and ``size_test``, and ``ensemble`` if the study
    wants one.
    """

    @property
    def force(self) -> float:
        """Reference load, N."""
        return self.reported.force

    @property
    def offsets(self) -> np.ndarray:
        """Offsets solved, mm."""
        return self["closure"]["offset"].values

    def at_load(self, stage: str, name: str, force: float | None = None) -> np.ndarray:
        """A variable over offsets, NaN below ten nodes in contact.

        At the reference load, or another one, N.
        """
        at = self.force if force is None else force
        nodes, values = (
            self.reported.curves(self[of][[what]])[what].sel(normal_force=at, method="nearest")
            for of, what in (("closure", "nodes"), (stage, name))
        )
        return np.where(nodes >= RESOLVED_NODES, values, np.nan)

    @cached_property
    def compliance(self) -> np.ndarray:
        """Compliance of the interface over offsets at the reference load, mm/MPa."""
        return self.compliance_under(self.force)

    def estimate_at_load(self, stage: str, name: str, force: float) -> Estimate:
        """As :meth:`at_load`, with the ends of the interval."""
        value, low, high = (self.at_load(stage, end, force) for end in names_of(name))
        return Estimate(value, low, high)

    def compliance_under(self, force: float) -> np.ndarray:
        """Compliance d w_int / d sigma_0 of the interface over offsets, mm/MPa; NaN where flush."""
        return self.at_load("closure", "interface_compliance", force)

    @cached_property
    def area_fraction(self) -> np.ndarray:
        """A_r/A_0 over offsets, corrected for the perimeter."""
        area = self.at_load("closure", "area_corrected")
        return area / self.area

    @cached_property
    def localisation(self) -> tuple[Estimate, np.ndarray]:
        """Exponent of Morisita's index over v at the reference load; offsets fitted, mm."""
        domains = self.curves("domains").sel(normal_force=self.force, method="nearest")
        exponent = Estimate.read(domains, "morisita_exponent")
        return exponent, self.offsets[domains["morisita_used"].values.astype(bool)]

    @cached_property
    def yields_everywhere(self) -> bool:
        """True if A_r = F/H within 1 %, so that the pressure is the hardness alone.

        In every state of ten nodes or more at the scan's own resolution, and in most of the coarser
        ones: the area of a few nodes is not known within 1 %.
        """
        hardness = self.settings["material"]["hardness"]
        curves = self["closure"]
        if not np.isfinite(hardness):
            return False
        share = curves["area_corrected"] * hardness / curves["normal_force"]
        share = share.where(curves["nodes"] >= RESOLVED_NODES)
        finest = share.sel(resolution=share["resolution"].min()).values
        within = [np.abs(one[np.isfinite(one)] - 1) < 0.01 for one in (finest, share.values)]
        return bool(within[0].size and within[0].all() and within[1].mean() > 0.5)

    def of_direction(self, name: str) -> np.ndarray:
        """A variable of the joint in the direction judged."""
        return self.along("joints")[name].values

    @cached_property
    def initial(self) -> np.ndarray:
        """Offsets of the first stage of sliding: up to the correlation length, if it is reached."""
        length = self.of_direction("correlation_length")
        return (self.offsets > 0) & (np.isnan(length) | (self.offsets <= length))

    @cached_property
    def between(self) -> np.ndarray:
        """Offsets beyond the correlation length at which the faces still correlate."""
        unrelated = self.of_direction("uncorrelated_offset")
        beyond = self.offsets > self.of_direction("correlation_length")
        return beyond & (~np.isfinite(unrelated) | (self.offsets < unrelated))

    @cached_property
    def unrelated(self) -> np.ndarray:
        """Offsets at which the faces no longer correlate."""
        return self.offsets >= self.of_direction("uncorrelated_offset")


def of_the_area(check: Callable[[Joint], Finding]) -> Callable[[Joint], Finding]:
    """A check of a statement on the contact area, which is ill-posed where all of it yields."""

    @wraps(check)
    def asked(joint):
        if joint.yields_everywhere:
            return Finding(ILL_POSED, BY_CONSTRUCTION)
        return check(joint)

    return asked


def trend(
    v: np.ndarray, values: np.ndarray, chosen: np.ndarray, symbol: str, *, rising: bool
) -> Finding:
    """Verdict on a claim of a power of v with a stated sign."""
    chosen = chosen & (values > 0)
    line = fit_line(np.log(v[chosen]), np.log(values[chosen]))
    return power_of_offset(line.slope, v[chosen], symbol, rising=rising)


def power_of_offset(exponent: Estimate, v: np.ndarray, symbol: str, *, rising: bool) -> Finding:
    """Verdict on an exponent over the offsets v that it was fitted to, by the sign wanted."""
    if not exponent.known:
        return Finding(UNDETERMINED, no_offsets("three"))
    return Finding(
        by_sign(exponent, rising=rising),
        f"x = {number(exponent)}",
        f"{symbol} ~ v^x, v = {compact(v[0])} to {compact(v[-1])} mm",
    )


def under_every_load(joint: Joint, rule: Callable[[float], Finding]) -> Finding:
    """Finding of a rule at the load nearest to the reference that decides, its verdict that of all.

    What a rule with a fixed limit finds at one load may be otherwise at the next.

    Parameters
    ----------
    joint : Joint
    rule : callable
        From a load, N, to its finding.
    """
    found = {force: rule(force) for force in joint.forces}
    decided = {force: one for force, one in found.items() if one.verdict != UNDETERMINED}
    if not decided:
        return rule(joint.force)
    force = min(decided, key=lambda one: abs(np.log(one / joint.force)))
    verdicts = [one.verdict for one in decided.values()]
    pressure = force / joint.area
    share_of = f"holds at {loads_of(verdicts.count(HOLDS), len(decided))}"
    if PARTLY in verdicts:
        share_of += f", in part at {loads_of(verdicts.count(PARTLY), len(decided))}"
    return decided[force]._replace(
        verdict=verdicts[0] if len(set(verdicts)) == 1 else PARTLY,
        numbers=f"{decided[force].numbers} at {compact(pressure)} MPa; {share_of}",
    )


def by_sign(found: Estimate, *, rising: bool) -> str:
    """Verdict on a claim of a sign, from the interval of the quantity."""
    above, below = found.low > 0, found.high < 0
    above, below = (above, below) if rising else (below, above)
    return HOLDS if above else FAILS if below else UNDETERMINED


def beyond_margin(found: Estimate, margin: float, *, rising: bool) -> str:
    """Verdict on a claim of a sign, with an equivalence margin.

    It holds where the whole interval lies beyond the margin, in part where all of it has the sign
    and some lies beyond, and fails where none does: a change smaller than the margin counts
    as none.

    Parameters
    ----------
    found : Estimate
        What is to have the sign.
    margin : float
    rising : bool
        Whether the sign is to be positive.
    """
    gain = found if rising else found.mapped(np.negative, falling=True)
    if gain.high <= margin:
        return FAILS
    if gain.low > 0:
        return HOLDS if gain.low > margin else PARTLY
    return UNDETERMINED


def within_margin(difference: Estimate, margin: float) -> str:
    """Verdict on a claim that there is no difference.

    It is none where the whole interval lies within the margin, and fails where the interval leaves
    out zero and some of it lies beyond.
    """
    if max(abs(difference.low), abs(difference.high)) <= margin:
        return HOLDS
    return FAILS if difference.low > 0 or difference.high < 0 else UNDETERMINED


def margin_words(name: str) -> str:
    """The equivalence margin of a claim, in words."""
    return f"margin {compact(all_claims()[name].margin, 6)}"


def level(values: Estimate, symbol: str, v: np.ndarray, margin: float) -> Finding:
    """Verdict on a claim of constancy over offsets, by the range over the mean.

    The ends of its interval are the least and the largest range that the intervals of the values
    allow.
    """
    known = np.isfinite(values.value)
    values, v = values[known], v[known]
    if len(v) < MIN_POINTS:
        return Finding(UNDETERMINED, no_offsets("three"))
    least = max(values.low.max() - values.high.min(), 0.0)
    spread = Estimate(np.ptp(values.value), least, values.high.max() - values.low.min())
    spread = spread.mapped(lambda end: end / values.value.mean())
    verdict = HOLDS if spread.high <= margin else FAILS if spread.low > margin else UNDETERMINED
    return Finding(
        verdict,
        f"{symbol} varies by {number(spread.mapped(lambda end: 100 * end), 0)} % of its mean",
        f"v = {compact(v[0])} to {compact(v[-1])} mm; margin {compact(100 * margin, 6)} %",
    )


def share(good: int, total: int) -> str:
    """Verdict on a claim that holds in some of all cases."""
    return HOLDS if good == total else PARTLY if good else FAILS


def no_offsets(needed: str) -> str:
    """Reason why a claim is undetermined."""
    return f"fewer than {needed} offsets"
