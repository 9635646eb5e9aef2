"""Statements of the paper on closure and contact area (sects. 4 and 5, Figs. 4 and 5)."""

import numpy as np

from ..core.claims import all_claims
from ..core.estimate import Estimate
from ..core.fitting import MIN_POINTS, fit_line
from ..core.limits import NEARLY
from ..core.text import compact, loads_of, number
from ..core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from ..joint.lag_dimension import LAG_RANGES
from .evidence import Evidence, of_a_kind
from .findings import (
    Finding,
    Joint,
    beyond_margin,
    difference_of,
    level,
    margin_words,
    no_offsets,
    of_the_area,
    power_of_offset,
    share,
    under_every_load,
)

#: Relative difference between two pressures that are one.
ROUNDING = 1e-9

#: Least ratio of two offsets at which a joint could differ.
MIN_SPREAD = 3.0

#: Closure from first contact is an extreme of the sample; compliance is a property of the joint.
_COMPLIANCE = "compliance"


@of_a_kind
def compliance_rises_at_first(joint: Joint, evidence: Evidence) -> Finding:
    """Compliance of the interface up to the correlation length, as a power of v.

    The claim holds where the interval of the power lies above the margin.
    """
    v = evidence.offsets()
    first = joint.initial(v)
    exponent = evidence.power_of_offset("compliance", first)
    name = "compliance_rises_at_first"
    return power_of_offset(name, exponent, v[first], _COMPLIANCE, rising=True)


@of_a_kind
def curves_overlap(joint: Joint, evidence: Evidence) -> Finding:
    """Range of the compliance of the interface over offsets a factor of three apart.

    The offsets begin beyond the correlation length, where the faces still correlate: once they do
    not, two unrelated faces meet at any v, and the curves overlap in any joint. The claim holds
    where the range of such a stretch of offsets lies within the margin. One specimen is judged at
    every load, realisations at the reference load.
    """

    def spread(force: float) -> Finding:
        findings = [finding for _, finding in _levels(joint, evidence, force)]
        order = (HOLDS, UNDETERMINED, FAILS)
        nothing = Finding(UNDETERMINED, _NO_STRETCH)
        return min(findings, key=lambda finding: order.index(finding.verdict), default=nothing)

    finding = under_every_load(joint, spread, evidence.judged_forces)
    v = evidence.offsets()
    unrelated, n = evidence.spread_over("compliance", joint.unrelated(v), joint.force)
    if n < MIN_POINTS or not unrelated.known:
        return finding
    percent = number(unrelated.mapped(lambda end: 100 * end), 0)
    lost = compact(v[joint.unrelated(v)][0])
    words = f"from v = {lost} mm on, where two unrelated faces meet, it varies by {percent} %"
    return finding._replace(explanation=words)


#: Reason why no stretch of offsets is judged.
_NO_STRETCH = (
    f"no three offsets from v to {compact(MIN_SPREAD, 6)} v begin where faces correlate in part"
)


def _levels(joint: Joint, evidence: Evidence, force: float) -> list[tuple[np.ndarray, Finding]]:
    """Stretches of offsets (n,) bool, and whether the compliance is level there under a load."""
    v, margin = evidence.offsets(), all_claims()["curves_overlap"].margin
    beyond = joint.between(v) | joint.unrelated(v)
    levels = []
    for first in v[joint.between(v)]:
        far = np.flatnonzero(v >= MIN_SPREAD * first * (1 - ROUNDING))
        if not far.size:
            continue
        part = beyond & (v >= first) & (v <= v[far[0]])
        change, n = evidence.spread_over("compliance", part, force)
        if n >= MIN_POINTS and change.known:
            levels.append((part, level(change, _COMPLIANCE, v[part], margin)))
    return levels


@of_a_kind
def compliance_rises_again(joint: Joint, evidence: Evidence) -> Finding:
    """Rise of the compliance after a plateau, as the correlation of the faces is lost.

    A plateau is a stretch of offsets on which the curves overlap, by the rule of that claim. The
    mean logarithm over the later offsets without correlation is compared with that over the
    plateau: the claim holds where the interval of the rise lies above the margin, and fails where
    the compliance rises all along, without a plateau, or not at all. One specimen is judged at
    every load, realisations at the reference load.
    """
    return under_every_load(
        joint, lambda force: _rises_again(joint, evidence, force), evidence.judged_forces
    )


def _rises_again(joint: Joint, evidence: Evidence, force: float) -> Finding:
    """Best finding over the stretches of offsets that may be a plateau, under a load."""
    v, margin = evidence.offsets(), all_claims()["compliance_rises_again"].margin
    findings = []
    for part, plateau in _levels(joint, evidence, force):
        after = joint.unrelated(v) & (v > v[part][-1])
        rise = evidence.rise_over("compliance", part, after, force)
        if not rise.known:
            continue
        change = rise.mapped(np.expm1)
        rises = beyond_margin(change, margin, rising=True)
        verdict = UNDETERMINED
        if FAILS in (rises, plateau.verdict):
            verdict = FAILS
        elif plateau.verdict == HOLDS:
            verdict = rises
        words = {HOLDS: "after a plateau", FAILS: "without a plateau before,"}
        before = words.get(plateau.verdict, "after what may be a plateau")
        percent = number(change.mapped(lambda end: 100 * end), 0, "+")
        later = f"after, v = {compact(v[after][0])} mm and more"
        note = f"before, {plateau.numbers}, {plateau.note}; {later}"
        findings.append(Finding(verdict, f"{before} compliance changes by {percent} %", note))
    order = (HOLDS, PARTLY, UNDETERMINED, FAILS)
    nothing = Finding(
        UNDETERMINED, "no three offsets for a plateau, or none without correlation later"
    )
    return min(findings, key=lambda finding: order.index(finding.verdict), default=nothing)


@of_a_kind
def composite_dimension_rises(joint: Joint, evidence: Evidence) -> Finding:
    """Dimension of the composite topography at the largest offset less that at the smallest.

    The dimension is that over the same lags at all offsets, for three choices of lags. The claim
    holds where it rises by more than the margin for each, and fails where it does for none. Offsets
    are compared that lie a factor of three apart or more.
    """
    name, v = "composite_dimension_rises", evidence.offsets()
    if v.size < 2 or v[-1] < MIN_SPREAD * v[0]:
        return Finding(UNDETERMINED, no_offsets("two, a factor of three apart,"))
    dimension = evidence.lag_dimension()
    first, last = dimension[0], dimension[-1]
    rise = [difference_of(last[i], first[i]) for i in range(len(LAG_RANGES))]
    if not all(change.known for change in rise):
        return Finding(UNDETERMINED, "the composite topography is flat at the first or last offset")
    margin = all_claims()[name].margin
    verdicts = [beyond_margin(change, margin, rising=True) for change in rise]
    low, high = (joint["joints"][f"lag_{end}"].values for end in ("min", "max"))
    also = ", ".join(
        f"{number(first.value[i])} to {number(last.value[i])} over {compact(low[i], 2)} "
        f"to {compact(high[i], 2)} mm"
        for i in range(1, len(LAG_RANGES))
    )
    return Finding(
        share(sum(verdict in (HOLDS, PARTLY) for verdict in verdicts), len(verdicts)),
        f"over lags of {compact(low[0], 2)} to {compact(high[0], 2)} mm it goes from "
        f"{number(first.value[0])} at "
        f"v = {compact(v[0])} mm to {number(last.value[0])} at {compact(v[-1])} mm",
        f"{also}; {margin_words(name)}",
        explanation="far below a lag the composite topography is a derivative of the face, far "
        "above it has the face's dimension",
    )


@of_a_kind
def compliance_goes_with_dimension(joint: Joint, evidence: Evidence) -> Finding:
    """Compliance of the interface and dimension of the composite topography over the offsets.

    The claim holds where both rise or both fall from the smallest to the largest offset, and fails
    where one rises and the other falls.
    """
    name, v = "compliance_goes_with_dimension", evidence.offsets()
    if v.size < 2 or v[-1] < MIN_SPREAD * v[0]:
        return Finding(UNDETERMINED, no_offsets("two, a factor of three apart,"))
    dimension = evidence.lag_dimension()
    steeper = difference_of(dimension[-1], dimension[0])[0]
    every = np.full(v.shape, True)
    softer = evidence.power_of_offset("compliance", every)
    if not (steeper.known and softer.known):
        return Finding(UNDETERMINED, "no dimension or no compliance at some offset")
    wider = _exponent_of_spread(joint)
    numbers = (
        f"as v grows from {compact(v[0])} to {compact(v[-1])} mm the dimension changes by "
        f"{number(steeper.value, 2, '+')} and the compliance as v^x, x = {number(softer)}"
    )
    margin, note = all_claims()[name].margin, margin_words(name)
    directions = [_sign(softer, margin), _sign(steeper, margin)]
    if 0 in directions:
        return Finding(UNDETERMINED, numbers, note)
    return Finding(
        HOLDS if directions[0] == directions[1] else FAILS,
        numbers,
        note,
        explanation=f"sigma_z of the composite topography grows as v^{number(wider)}: a joint slid "
        "farther is more compliant because its gap is wider",
    )


def _sign(change: Estimate, margin: float) -> int:
    """Sign of a change that is sure and may exceed the margin; 0 of none, or of one not known."""
    for sign, rising in ((1, True), (-1, False)):
        if beyond_margin(change, margin, rising=rising) in (HOLDS, PARTLY):
            return sign
    return 0


def _exponent_of_spread(joint: Joint) -> float:
    """Exponent over v of the standard deviation sigma_z of the composite topography."""
    slid = joint.offsets > 0
    spread = joint.along("closure")["composite_spread"].values[slid]
    return float(fit_line(np.log(joint.offsets[slid]), np.log(spread)).slope.value)


@of_a_kind
def larger_samples_close_more(joint: Joint, evidence: Evidence) -> Finding:
    """Exponents against the size of sub-windows: of closure from first touch and of compliance.

    Each grows with size where its interval lies above the margin, and does not where it lies below.
    The claim holds where both grow, and in part where one does.
    """
    name = "larger_samples_close_more"
    margin = all_claims()[name].margin
    exponents = {
        "closure from first touch": evidence.size_exponent("closure_exponent"),
        "compliance": evidence.size_exponent("compliance_exponent"),
    }
    exponents = {words: exponent for words, exponent in exponents.items() if exponent.known}
    if not exponents:
        return Finding(UNDETERMINED, "too few nodes in contact in sub-windows of two sizes")
    verdicts = [beyond_margin(exponent, margin, rising=True) for exponent in exponents.values()]
    decided = [verdict for verdict in verdicts if verdict != UNDETERMINED]
    grows = sum(verdict in (HOLDS, PARTLY) for verdict in decided)
    verdict = PARTLY if grows else FAILS if decided else UNDETERMINED
    return Finding(
        HOLDS if verdicts == [HOLDS, HOLDS] else verdict,
        " and ".join(
            f"{words} ~ b^x, x = {number(exponent)}" for words, exponent in exponents.items()
        ),
        f"{evidence.reference}; {margin_words(name)}",
    )


@of_the_area
def area_is_linear(joint: Joint) -> Finding:
    """Exponent m of A_r ~ F^m at every offset, A_r corrected for the perimeter."""
    law = joint.along("area")
    exponent = Estimate.read(law, "corrected_exponent")
    if not exponent.known.any():
        return Finding(UNDETERMINED, "no area law could be fitted")
    exponent = exponent[exponent.known]
    value = exponent.value
    near = int((np.abs(value - 1) <= NEARLY).sum())
    apart = int(((exponent.high < 1 - NEARLY) | (exponent.low > 1 + NEARLY)).sum())
    verdict = FAILS if apart == value.size else PARTLY if apart else HOLDS
    verdict = UNDETERMINED if not apart and 2 * near <= value.size else verdict
    ends = " to ".join(dict.fromkeys(number(m) for m in (value.min(), value.max())))
    return Finding(
        verdict,
        f"m = {ends}",
        f"A_r ~ F^m; {near} of {value.size} exponents lie within {compact(NEARLY, 6)} of "
        "1, the intervals "
        f"of {apart or 'none'} outside",
    )


@of_the_area
@of_a_kind
def area_falls(joint: Joint, evidence: Evidence) -> Finding:
    """Contact area against offset, as a power of v, compared with the margin."""
    v = evidence.offsets()
    exponent = evidence.power_of_offset("area", np.full(v.shape, True))
    return power_of_offset("area_falls", exponent, v, "A_r", rising=False)


@of_the_area
@of_a_kind
def area_settles(joint: Joint, evidence: Evidence) -> Finding:
    """Range of the contact area beyond the correlation length, over a factor of three of v.

    The claim holds where the interval of the range lies within the margin.
    """
    v = evidence.offsets()
    beyond = joint.between(v) | joint.unrelated(v)
    spread, n = evidence.spread_over("area", beyond, joint.force)
    if n < MIN_POINTS or v[beyond][-1] < MIN_SPREAD * v[beyond][0]:
        return Finding(UNDETERMINED, no_offsets("three, over a factor of three,"))
    return level(spread, "A_r", v[beyond], all_claims()["area_settles"].margin)


def refinement_changes_little(joint: Joint) -> Finding:
    """Change of closure and contact area from every second point of the scan to all points.

    Closure counts from a seat that both grids resolve, as first touch depends on the highest point
    alone. The claim holds where both changes lie within the margin at every load, and in part where
    only one does, or at some loads.
    """
    margin = all_claims()["refinement_changes_little"].margin
    curves = joint.reported.at_offset(joint.along("closure"))
    finest = int(curves["resolution"].min())
    grids = [
        curves.sel(resolution=k) for k in (2 * finest, finest) if k in curves["resolution"].values
    ]
    pressures = joint.forces / joint.area
    seat = max(float(grid["seating_pressure"]) for grid in grids)
    counts = pressures >= seat * (1 - ROUNDING)
    for grid in grids:
        counts = counts & np.isfinite(grid["interface_closure"].values)
    if len(grids) < 2 or counts.sum() < 2:
        return Finding(UNDETERMINED, "no two loads with ten nodes in contact at both spacings")
    closures, areas = (
        [grid[name].values[counts] for grid in grids]
        for name in ("interface_closure", "area_corrected")
    )
    changes = {
        "closure from the seat": _change(*(closure[1:] - closure[0] for closure in closures)),
        "A_r": _change(*(area[1:] for area in areas)),
    }
    little = {name: int((np.abs(change) <= margin).sum()) for name, change in changes.items()}
    n = int(counts.sum()) - 1
    words = (
        f"{name} changes by {number(100 * change.min(), 0, '+')} to "
        f"{number(100 * change.max(), 0, '+')} % (within "
        f"{compact(100 * margin, 6)} % at {loads_of(little[name], n)})"
        for name, change in changes.items()
    )
    return Finding(
        share(sum(little.values()), 2 * n),
        f"with all points in place of every second one, {' and '.join(words)}",
        f"from a seat of {compact(pressures[counts][0])} MPa",
    )


def _change(coarse: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """Change from a coarse grid to a fine one, a fraction."""
    return fine / coarse - 1
