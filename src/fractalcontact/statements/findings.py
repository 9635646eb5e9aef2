"""Judging of a statement: the joint's stages, verdicts, and rules that several share."""

from collections.abc import Callable
from functools import cached_property, wraps
from typing import NamedTuple

import numpy as np

from ..core.claims import all_claims
from ..core.estimate import Estimate, names_of
from ..core.limits import ALL_CRUSH, RESOLVED_NODES
from ..core.subject import Subject
from ..core.text import compact, loads_of, number
from ..core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED

#: Reason why statements on the contact area are ill-posed under a hardness.
BY_CONSTRUCTION = "A_r = F/H, because all contacts yield"

#: Statements on the dilatancy: a specimen that was chosen for one says nothing of the strength.
_OF_DILATANCY = ("dilatancy_flattens", "dilatancy_flattens_in_two", "dilatancy_is_anisotropic")


class Finding(NamedTuple):
    """Verdict on one statement, its numbers, and a remark.

    Captions quote the verdict and the numbers. The note stands in the table alone, and so do
    ``explanation``, what a null model does in the same data, which never changes the verdict, and
    ``judged_on``, which is empty where the whole subject was judged.
    """

    verdict: str
    numbers: str
    note: str = ""
    judged_on: str = ""
    explanation: str = ""


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
        """True if A_r = F/H within `ALL_CRUSH`, so that the pressure is the hardness alone.

        In every state of ten nodes or more at the scan's own resolution, and in most of the coarser
        ones. The raw area decides: the corrected one is never below F/H, whatever the nodes bear.
        """
        hardness = self.settings["material"]["hardness"]
        curves = self["closure"]
        if not np.isfinite(hardness):
            return False
        share = curves["area"] * hardness / curves["normal_force"]
        share = share.where(curves["nodes"] >= RESOLVED_NODES)
        finest = share.sel(resolution=share["resolution"].min()).values
        within = [np.abs(one[np.isfinite(one)] - 1) < ALL_CRUSH for one in (finest, share.values)]
        return bool(within[0].size and within[0].all() and within[1].mean() > 0.5)

    def of_direction(self, name: str) -> np.ndarray:
        """A variable of the joint in the direction judged."""
        return self.along("joints")[name].values

    def initial(self, v: np.ndarray) -> np.ndarray:
        """Offsets (n,) of the first stage of sliding: up to the correlation length, if reached."""
        length = self.of_direction("correlation_length")
        return (v > 0) & (np.isnan(length) | (v <= length))

    def between(self, v: np.ndarray) -> np.ndarray:
        """Offsets (n,) beyond the correlation length at which the faces still correlate."""
        lost = self.of_direction("uncorrelated_offset")
        beyond = v > self.of_direction("correlation_length")
        return beyond & (~np.isfinite(lost) | (v < lost))

    def unrelated(self, v: np.ndarray) -> np.ndarray:
        """Offsets (n,) at which the faces no longer correlate."""
        return v >= self.of_direction("uncorrelated_offset")


def of_the_area(check: Callable[[Joint], Finding]) -> Callable[[Joint], Finding]:
    """A check of a statement on the contact area, which is ill-posed where all of it yields."""

    @wraps(check)
    def asked(joint):
        if joint.yields_everywhere:
            return Finding(ILL_POSED, BY_CONSTRUCTION)
        return check(joint)

    return asked


def of_unchosen_dilatancy(check: Callable[[Joint], Finding]) -> Callable[[Joint], Finding]:
    """A check of a statement on strength, which a specimen chosen for its dilatancy cannot decide.

    The strength is that of the dilatancy angle. The numbers stand, the verdict is undetermined.
    """

    @wraps(check)
    def asked(joint):
        finding = check(joint)
        chosen = [
            how for name, how in joint.settings["chosen_for"].items() if name in _OF_DILATANCY
        ]
        if not chosen or finding.verdict == UNDETERMINED:
            return finding
        numbers = f"{finding.numbers}, but the specimen was chosen for its dilatancy"
        note = f"{finding.note}; {chosen[0]}"
        return finding._replace(verdict=UNDETERMINED, numbers=numbers, note=note)

    return asked


def power_of_offset(
    name: str, exponent: Estimate, v: np.ndarray, symbol: str, *, rising: bool
) -> Finding:
    """Verdict on an exponent over the offsets v that it was fitted to, by sign and margin."""
    if not exponent.known:
        return Finding(UNDETERMINED, no_offsets("three"))
    return Finding(
        beyond_margin(exponent, all_claims()[name].margin, rising=rising),
        f"x = {number(exponent)}",
        f"{symbol} ~ v^x, v = {compact(v[0])} to {compact(v[-1])} mm; {margin_words(name)}",
    )


def under_every_load(joint: Joint, rule: Callable[[float], Finding], forces: np.ndarray) -> Finding:
    """Finding of a rule at the load nearest to the reference that decides, its verdict that of all.

    ``rule`` leads from a load, N, to a finding. With a fixed limit it may differ from load to load.
    """
    findings = {force: rule(force) for force in forces}
    decided = {
        force: finding for force, finding in findings.items() if finding.verdict != UNDETERMINED
    }
    if not decided:
        return rule(joint.force)
    force = min(decided, key=lambda finding: abs(np.log(finding / joint.force)))
    verdicts = [finding.verdict for finding in decided.values()]
    pressure = force / joint.area
    if len(findings) == 1:
        return decided[force]._replace(
            numbers=f"{decided[force].numbers} at {compact(pressure)} MPa"
        )
    share_of = f"true at {loads_of(verdicts.count(HOLDS), len(decided))}"
    if PARTLY in verdicts:
        share_of += f", in part at {loads_of(verdicts.count(PARTLY), len(decided))}"
    return decided[force]._replace(
        verdict=verdicts[0] if len(set(verdicts)) == 1 else PARTLY,
        numbers=f"{decided[force].numbers} at {compact(pressure)} MPa; {share_of}",
    )


def by_sign(estimate: Estimate, *, rising: bool) -> str:
    """Verdict on a claim of a sign, from the interval of the quantity."""
    above, below = estimate.low > 0, estimate.high < 0
    above, below = (above, below) if rising else (below, above)
    return HOLDS if above else FAILS if below else UNDETERMINED


def beyond_margin(estimate: Estimate, margin: float, *, rising: bool) -> str:
    """Verdict on a claim of a sign, with an equivalence margin.

    It holds where the whole interval lies beyond the margin, in part where all of it has the sign
    and some lies beyond, and fails where none does: a change smaller than the margin counts as
    none.
    """
    gain = estimate if rising else estimate.mapped(np.negative, falling=True)
    if gain.high <= margin:
        return FAILS
    if gain.low > 0:
        return HOLDS if gain.low > margin else PARTLY
    return UNDETERMINED


def trend_over_sizes(
    name: str, exponent: Estimate, numbers: str, source: str, *, rising: bool
) -> Finding:
    """Finding on an exponent against the size of sub-windows; ``source`` says of which states."""
    if not exponent.known:
        return Finding(UNDETERMINED, "too few nodes in contact in sub-windows of two sizes")
    verdict = beyond_margin(exponent, all_claims()[name].margin, rising=rising)
    return Finding(verdict, numbers, f"{source}; {margin_words(name)}")


def within_margin(difference: Estimate, margin: float) -> str:
    """Verdict on a claim that there is no difference.

    There is none where the whole interval lies within the margin, and one where the whole interval
    lies beyond it on one side.
    """
    if max(abs(difference.low), abs(difference.high)) <= margin:
        return HOLDS
    return FAILS if max(difference.low, -difference.high) > margin else UNDETERMINED


def difference_of(first: Estimate, second: Estimate) -> Estimate:
    """Difference of two estimates with independent errors."""
    below = np.hypot(first.value - first.low, second.high - second.value)
    above = np.hypot(first.high - first.value, second.value - second.low)
    value = first.value - second.value
    return Estimate(value, value - below, value + above)


def margin_words(name: str) -> str:
    """The equivalence margin of a claim, in words."""
    return f"margin {compact(all_claims()[name].margin, 6)}"


def level(spread: Estimate, symbol: str, v: np.ndarray, margin: float) -> Finding:
    """Verdict on a claim of constancy over offsets, by the range over the mean."""
    return Finding(
        HOLDS if spread.high <= margin else FAILS if spread.low > margin else UNDETERMINED,
        f"{symbol} varies by {number(spread.mapped(lambda end: 100 * end), 0)} %",
        f"v = {compact(v[0])} to {compact(v[-1])} mm; margin {compact(100 * margin, 6)} %",
    )


def share(good: int, total: int) -> str:
    """Verdict on a claim that holds in some of all cases."""
    return HOLDS if good == total else PARTLY if good else FAILS


def no_offsets(needed: str) -> str:
    """Reason why a claim on offsets is undetermined: there are too few."""
    return f"fewer than {needed} offsets"
