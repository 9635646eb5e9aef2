"""Statements of the paper on contact domain and size (sects. 6 and 7, Figs. 1b, 8 to 13)."""

import numpy as np
import xarray as xr

from ..core.claims import all_claims
from ..core.estimate import Estimate
from ..core.fitting import MIN_POINTS
from ..core.intervals import mean_difference
from ..core.limits import NEAR_FULL, NEAR_POINTS, NEARLY
from ..core.text import compact, loads_of, number
from ..core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from .evidence import ESTIMATES, Evidence, Trend, evidence_of, of_a_kind
from .findings import (
    Finding,
    Joint,
    beyond_margin,
    margin_words,
    of_the_area,
    of_unchosen_dilatancy,
    share,
    trend_over_sizes,
    within_margin,
)

#: Least decades of load over which a change with the load is judged.
MIN_DECADES = 1.0

#: Dimension of a line: structured contact points have less, linear contact structures more.
LINE = 1.0


@of_the_area
@of_a_kind
def area_is_lacunar(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of A_r over the resolutions at the reference load, and its change over them.

    The area falls with refinement where 2 - Delta_sigma exceeds the margin. It follows one power
    law where the two finest and the two coarsest resolutions give the same Delta_sigma within the
    margin; otherwise the claim holds in part.
    """
    name = "area_is_lacunar"
    margin = all_claims()[name].margin
    delta, bend = evidence.area_dimension(), evidence.area_bend()
    if not np.isfinite(delta.width):
        return Finding(UNDETERMINED, f"fewer than {MIN_POINTS} usable resolutions")
    # A_r ~ s^(2 - Delta_sigma): it falls with refinement where the exponent is positive.
    falls = beyond_margin(delta.mapped(lambda value: 2 - value, falling=True), margin, rising=True)
    one_power = within_margin(bend, margin)
    words = {HOLDS: "one power", FAILS: "not one power"}.get(
        one_power, "undetermined whether one power"
    )
    return Finding(
        falls if one_power == HOLDS or falls != HOLDS else PARTLY,
        f"A_r ~ s^(2 - Delta_sigma), Delta_sigma = {number(delta)}",
        f"{evidence.reference}; {words}: from the coarsest to the finest resolutions Delta_sigma "
        f"changes by {number(bend, 2, '+')}; {margin_words(name)}; at light load the slopes "
        f"h'_rms(s) of the "
        "surface set this exponent",
    )


@of_the_area
@of_a_kind
def estimates_agree(joint: Joint, evidence: Evidence) -> Finding:
    """Delta_sigma by A_r(s) minus that by boxes under every load, compared with the margin."""
    name = "estimates_agree"
    difference, pressures = evidence.difference()
    if not pressures.size:
        return Finding(UNDETERMINED, "no load has both estimates with their intervals")
    verdicts = _each_within(difference, name)
    decided = [verdict for verdict in verdicts if verdict != UNDETERMINED]
    ends = " to ".join(dict.fromkeys(f"{number(d, 2, '+')}" for d in difference.value[[0, -1]]))
    return Finding(
        share(decided.count(HOLDS), len(decided)) if decided else UNDETERMINED,
        f"Delta_sigma by A_r(s) minus that by boxes is {ends}; they differ at "
        f"{loads_of(verdicts.count(FAILS), len(verdicts))}",
        f"{_between(pressures)}; {margin_words(name)}",
    )


@of_the_area
def dimension_rises_by_area(joint: Joint) -> Finding:
    """Slope of Delta_sigma from A_r(s) over the decades of F, compared with the margin.

    The specimen is judged where its loads span a decade and those at which every realisation has a
    Delta_sigma do not.
    """
    name, evidence = "dimension_rises_by_area", evidence_of(joint)
    trends = [(one, one.trend("area")) for one in (evidence, Evidence(joint))]
    judged, trend = next((pair for pair in trends if _decades(pair[1]) >= MIN_DECADES), trends[0])
    return judged.of(_rise(trend, name))


@of_a_kind
def dimension_rises_by_boxes(joint: Joint, evidence: Evidence) -> Finding:
    """Slope of Delta_sigma by boxes over the decades of F, compared with the margin.

    Fig. 13 has the slopes 2 - Delta_sigma of eq. 6, which fall as Delta_sigma rises: what the
    sub-windows of one joint show stands beside the verdict. So does the bearing-area cut of as many
    nodes, which explains a rise that is no faster than its own: more nodes fill more boxes wherever
    they lie.
    """
    name, trend = "dimension_rises_by_boxes", evidence.trend("box")
    finding = _rise(trend, name)
    if finding.verdict not in (HOLDS, PARTLY):
        return finding
    cut = _beside_cut(trend.departure, all_claims()[name].margin)
    return finding._replace(explanation="; ".join(filter(None, (cut, _measured_slopes(joint)))))


def _beside_cut(less: Estimate, margin: float) -> str:
    """Rise of Delta_sigma less that of the bearing-area cut, in words."""
    if not less.known:
        return "not compared with the bearing-area cut, which is near 2 or has no dimension"
    faster = beyond_margin(less, margin, rising=True)
    words = {
        FAILS: "no faster than the bearing-area cut",
        HOLDS: "faster than the bearing-area cut",
    }.get(faster, "not surely faster than the bearing-area cut")
    return f"{words}: the difference is {number(less, 2, '+')} per decade"


def _decades(trend: Trend) -> float:
    """Decades of load that the values of a trend span; 0 without any."""
    ends = trend.pressures[[0, -1]] if trend.pressures.size else np.ones(2)
    return float(np.log10(ends[1] / ends[0]))


def _rise(trend: Trend, name: str) -> Finding:
    """Verdict on a slope over the decades of F; undetermined where the loads span less than one."""
    if not trend.slope.known:
        return Finding(UNDETERMINED, "too few loads have a dimension")
    numbers = f"Delta_sigma changes by {number(trend.slope, 2, '+')} per decade of F"
    note = f"{_between(trend.pressures)}; {margin_words(name)}"
    decades = _decades(trend)
    if decades < MIN_DECADES:
        few = f"the loads span {number(decades, 1)} decades, {compact(MIN_DECADES, 6)} needed"
        return Finding(UNDETERMINED, f"{numbers}, but {few}", note)
    verdict = beyond_margin(trend.slope, all_claims()[name].margin, rising=True)
    return Finding(verdict, numbers, note)


def _measured_slopes(joint: Joint) -> str:
    """Exponents of A_r/A_0 against b under the lightest and the heaviest load, in words."""
    test = joint["size_test"]
    test = test.isel(normal_force=~test["beyond_study"].values.astype(bool))
    exponent = _known_loads(Estimate.read(test, "area_exponent"), test["nominal_pressure"].values)
    if not exponent:
        return ""
    ends = [exponent[i] for i in dict.fromkeys((0, len(exponent) - 1))]
    words = " and ".join(f"{number(x)} at {compact(pressure)} MPa" for x, pressure in ends)
    return f"measured on sub-windows of this specimen, A_r/A_0 ~ b^x has x = {words}"


def _known_loads(estimate: Estimate, pressures: np.ndarray) -> list[tuple[Estimate, float]]:
    """Estimates and nominal pressures, MPa, of the loads that have one with an interval."""
    return [(estimate[i], pressures[i]) for i in np.flatnonzero(np.isfinite(estimate.width))]


@of_the_area
def lines_form_above_one(joint: Joint) -> Finding:
    """Fraction of the contact in long clusters: states with Delta_sigma above 1 less those below.

    A cluster is long if it is three times as long as wide. States are those of all loads and
    offsets whose Delta_sigma by boxes lies surely on one side of 1. The claim holds where the
    interval of the difference lies above the margin.
    """
    name = "lines_form_above_one"
    states = joint.curves("domains")
    delta, long = Estimate.read(states, "delta_sigma"), states["long_share"].values
    known = np.isfinite(long)
    above, below = known & (delta.low > LINE), known & (delta.high < LINE)
    counts = f"Delta_sigma is surely above 1 in {above.sum() or 'no'} states, below in "
    counts += f"{below.sum() or 'none'}"
    if not above.any() or not below.any():
        return Finding(UNDETERMINED, counts)
    difference = mean_difference(long[above], long[below])
    ends = [100 * long[side].mean() for side in (above, below)]
    percent = difference.mapped(lambda end: 100 * end)
    margin = all_claims()[name].margin
    note = f"{counts}; margin {compact(100 * margin, 6)} %"
    numbers = (
        f"clusters three times as long as wide hold {number(ends[0], 0)} % of the contact where "
        f"Delta_sigma is above 1 and {number(ends[1], 0)} % where it is below; they differ by "
        f"{number(percent, 0, '+')} %"
    )
    if not np.isfinite(difference.width):
        return Finding(UNDETERMINED, numbers, f"{note}; three states needed")
    return Finding(beyond_margin(difference, margin, rising=True), numbers, note)


def elimination_finds_the_set(joint: Joint) -> Finding:
    """Nodes that elimination drops and that interpenetrate, on a coarse grid of this joint.

    The paper's algorithm drops nodes in tension and takes none back, so that each domain lies in
    the one before. With Love's kernel this is a theorem, so that the row checks the solver: no
    dropped node interpenetrates at any of three closures.
    """
    test = joint["error_budget"]
    wrong, steps = test["elimination_wrong"].values, test["elimination_steps"].values
    tried = np.isfinite(wrong)
    if not tried.any():
        return Finding(UNDETERMINED, "the faces are flush")
    right = int((wrong[tried] == 0).sum())
    return Finding(
        share(right, int(tried.sum())),
        f"elimination ends on the contact set at {right or 'none'} of {tried.sum()} closures, "
        f"after up to {number(steps[tried].max(), 0)} systems",
        f"{int(test['elimination_side'])} nodes along a side",
        explanation="with Love's kernel no topography defeats elimination; with the paper's plate "
        "read as a rigid square one can be constructed that does",
    )


@of_a_kind
def dimension_spans_all(joint: Joint, evidence: Evidence) -> Finding:
    """Smallest and largest Delta_sigma by box counts, which the claim expects near 0 and near 2.

    The paper expects 2 of plastic contact alone. An elastic joint is asked for a dimension near 0
    under light loads and for one above 1 under heavy loads.
    """
    (delta, pressures), random = evidence.box_dimension()
    if not pressures.size:
        return Finding(UNDETERMINED, "no load with a dimension by boxes")
    plastic = bool(np.isfinite(joint.settings["material"]["hardness"]))
    note = f"{_between(pressures)}; near 0 a single node changes the answer"
    asked = by_design(joint) if plastic else "; 2 is asked of plastic contact alone"
    return span_finding(delta, random, pressures, note + asked, plastic=plastic)


def span_finding(
    delta: Estimate, random: np.ndarray, pressures: np.ndarray, note: str, *, plastic: bool
) -> Finding:
    """Verdict on a Delta_sigma that is claimed to go from 0 through 1 to 2 as the load grows.

    It holds where the smallest value is near 0 and the largest reaches the upper end: 2 for plastic
    contact, more than 1 for elastic contact. It holds in part where the values pass 1 from surely
    below, and fails where the upper end is surely missed, or where no value is surely below 1
    though that of as many random nodes is. ``delta`` and ``random`` are (n,), ``pressures`` MPa,
    ascending.
    """
    lowest, highest = int(np.argmin(delta.value)), int(np.argmax(delta.value))
    lower, upper = delta[lowest], delta[highest]
    end = NEAR_FULL if plastic else LINE
    if max(upper.high, delta.high[-1]) < end:
        verdict = FAILS
    elif lower.high >= LINE:
        verdict = FAILS if random[lowest] < min(LINE, lower.low) else UNDETERMINED
    elif upper.low >= end:
        verdict = HOLDS if lower.high <= NEAR_POINTS else PARTLY
    else:
        verdict = PARTLY if lower.high <= NEAR_POINTS else UNDETERMINED
    return Finding(
        verdict,
        f"Delta_sigma by boxes goes from {_of_a_set(lower)} to {_of_a_set(upper)} up to "
        f"{compact(pressures[-1])} MPa",
        note,
    )


def _of_a_set(dimension: Estimate) -> str:
    """A dimension with its interval, if it has one."""
    known = np.isfinite(dimension.width)
    return f"{number(dimension)}" if known else f"{number(dimension.value)} (no interval)"


def by_design(joint: Joint) -> str:
    """Note on the upper end where a hardness caps the pressure."""
    largest = joint.states("domains")["fit_max"].values
    largest = largest[np.isfinite(largest)]
    full = "; at full yield it is 2 by construction"
    if not largest.size or largest.min() > largest.max() / 2:
        return full
    return (
        f"; as boxes fill, the largest fitted box shrinks from {compact(largest.max(), 2)} to "
        f"{compact(largest.min(), 2)} mm in this specimen{full}"
    )


@of_the_area
@of_a_kind
def size_effect_follows(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of corrected A_r/A_0 minus that of eq. 6, Delta_sigma - 2, by load and estimate.

    Eq. 6 holds where the whole interval of this difference lies within the margin. Otherwise it
    fails where the interval excludes zero.
    """
    name = "size_effect_follows"
    found = {words: evidence.beyond_eq6(by) for by, words in ESTIMATES.items()}
    found = {words: one for words, one in found.items() if one.pressures.size}
    if not found:
        return Finding(
            UNDETERMINED, "no load has both the exponent and Delta_sigma of the same window"
        )
    each = [verdict for one in found.values() for verdict in _each_within(one.estimate, name)]
    decided = [verdict for verdict in each if verdict != UNDETERMINED]
    reference = joint.force / joint.area
    nearest = {
        words: one.estimate[int(np.argmin(np.abs(np.log(one.pressures / reference))))]
        for words, one in found.items()
    }
    pressures = np.unique(np.concatenate([one.pressures for one in found.values()]))
    less = " and ".join(f"{number(one, 2, '+')} {words}" for words, one in nearest.items())
    exponent = evidence.size_exponent("area_exponent")
    law = f"A_r/A_0 ~ b^x, x = {number(exponent)}" if exponent.known else "A_r/A_0 ~ b^x"
    agree = "no load is decisive"
    if decided:
        agree = f"eq. 6 agrees in {decided.count(HOLDS) or 'none'} of {len(decided)} decisive cases"
    return Finding(
        share(decided.count(HOLDS), len(decided)) if decided else UNDETERMINED,
        f"{law}; x minus the exponent of eq. 6 is {less}",
        f"{_between(pressures)}; {agree}, on windows within one joint; {margin_words(name)}",
    )


def _each_within(differences: Estimate, name: str) -> list[str]:
    """Verdicts on a claim of no differences, with its margin."""
    margin = all_claims()[name].margin
    return [within_margin(differences[i], margin) for i in range(np.size(differences.value))]


def _between(pressures: np.ndarray) -> str:
    """A range of nominal pressures in words; ascending."""
    ends = dict.fromkeys(f"{compact(end)}" for end in (pressures[0], pressures[-1]))
    return f"{' to '.join(ends)} MPa"


@of_the_area
@of_a_kind
def larger_domains_are_less_dense(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of corrected A_r/A_0 against the size of sub-windows.

    The claim holds where the interval lies below minus the margin, and fails where it lies above.
    """
    name, exponent = "larger_domains_are_less_dense", evidence.size_exponent("area_exponent")
    source = f"A_r/A_0 ~ b^x {evidence.reference}"
    return trend_over_sizes(name, exponent, f"x = {number(exponent)}", source, rising=False)


@of_unchosen_dilatancy
def strength_falls_with_size(joint: Joint) -> Finding:
    """Exponents of shear strength against window size at equal v/b, as laboratories compare sizes.

    The claim holds where strength falls by more than the margin in every case, in part where it
    falls in some, and fails where it falls in none and some case shows no fall beyond the margin. A
    truncated angle makes a strength a lower bound; exponents are then the largest that the bounds
    allow. At equal v/b a larger window has also slid farther: slopes of the dilatancy at equal v
    tell this cause from the size itself.
    """
    name = "strength_falls_with_size"
    windows = joint["windows"]
    strength = Estimate.read(windows, "strength_at_equal_v_over_b_exponent")
    strength = strength[np.isfinite(strength.value)]
    cases = strength.value.size
    if not cases:
        return Finding(UNDETERMINED, "no v/b has three sizes of window in three steps of sliding")
    margin = all_claims()[name].margin
    verdicts = [beyond_margin(strength[i], margin, rising=False) for i in range(cases)]
    clear, no_fall = verdicts.count(HOLDS), verdicts.count(FAILS)
    falls, clearly = clear + verdicts.count(PARTLY), clear or "none"
    # Undetermined cases do not count.
    verdict = PARTLY if falls else FAILS if no_fall else UNDETERMINED
    bounded = int(np.isneginf(strength.low).sum())
    return Finding(
        HOLDS if clear == cases else verdict,
        f"tau falls at equal v/b in {falls or 'none'} of {cases} cases"
        f"{f', by more than the margin in {clearly}' if clear < falls else ''}"
        f"{f', surely not in {no_fall}' if no_fall else ''}",
        f"x = {_ends(strength)} at equal v/b; {margin_words(name)}"
        f"{f', bounds from above in {bounded} of them with truncated angles' if bounded else ''}",
        explanation=_at_equal_v(windows),
    )


def _at_equal_v(windows: xr.Dataset) -> str:
    """Cases in which the slope of the dilatancy falls with size at equal v, in words."""
    slope = Estimate.read(windows, "slope_at_equal_v_exponent")
    slope = slope[np.isfinite(slope.value)]
    if not slope.value.size:
        return ""
    falls = int(((slope.high < 0) & (slope.low < -NEARLY)).sum())
    return (
        f"at equal v the slope of the dilatancy falls with size in {falls or 'none'} of "
        f"{slope.value.size} cases (x = {_ends(slope)}): at equal v/b a larger window has slid "
        "farther"
    )


def _ends(exponents: Estimate) -> str:
    """Least and largest exponent in words."""
    ends = (exponents.value.min(), exponents.value.max())
    return " to ".join(dict.fromkeys(f"{number(end)}" for end in ends))
