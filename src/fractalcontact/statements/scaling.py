"""Statements of the paper on contact domain and size (sects. 6 and 7, Figs. 1b, 8 to 13)."""

from collections import Counter
from dataclasses import replace

import numpy as np

from ..core.estimate import Estimate
from ..core.fitting import MIN_POINTS, slope_error
from ..core.limits import LOOSELY
from ..core.verdicts import AGREES, DECIDED, FAILS, HOLDS, PARTLY, UNDETERMINED
from ..domain.pressure_trend import pressure_trend
from ..domain.renormalisation import MIN_RESOLUTIONS
from .findings import Finding, Joint, beyond_margin, by_sign, of_the_area, share
from .local_slopes import one_slope

#: Delta_sigma up to here is near 0, and from here on near 2, the ends of the paper's Fig. 12.
NEAR_POINTS, NEAR_FULL = 0.25, 1.75

#: The two estimates of Delta_sigma, as their variables and in words.
ESTIMATES = {"area": "by A_r(s)", "box": "by boxes"}


@of_the_area
def area_is_lacunar(joint: Joint) -> Finding:
    """Exponent of A_r over the resolutions, at the reference load."""
    state = joint.state("scaling")
    delta = Estimate.read(state, "delta_sigma")
    if not np.isfinite(delta.width):
        few = f"{int(state['n'])} of {MIN_RESOLUTIONS} resolutions needed"
        return Finding(UNDETERMINED, few)
    # A_r ~ s^(2 - Delta_sigma): it falls with refinement where the exponent is positive.
    return Finding(
        by_sign(delta.mapped(lambda value: 2 - value, falling=True), rising=True),
        f"A_r ~ s^(2 - Delta_sigma), Delta_sigma = {delta:.2f}",
        f"over {int(state['n'])} resolutions, r2 = {float(state['r2']):.3f}; at light load the "
        "exponent is that of the slopes h'_rms(s) of the surface",
    )


def boxes_follow_one_law(joint: Joint) -> Finding:
    """Local slopes of the box counts at the reference load.

    They show the curvature of the counts; how well one slope is known says nothing of it.
    """
    return one_slope(joint.state("domains"))


@of_the_area
def estimates_agree(joint: Joint) -> Finding:
    """Difference of Delta_sigma by A_r(s) and by boxes, over all loads that decide it.

    Equal is a difference whose whole interval is within a quarter, unequal one whose interval
    leaves out zero.
    """
    difference = Estimate.read(joint.states("scaling"), "difference")
    equal = (difference.low >= -LOOSELY) & (difference.high <= LOOSELY)
    known = equal | (difference.low > 0) | (difference.high < 0)
    if not known.any():
        both = int(np.isfinite(difference.width).sum())
        return Finding(
            UNDETERMINED,
            f"{both} loads have both estimates; at none is their difference surely below "
            f"{LOOSELY:g} or surely not zero",
        )
    agree = int(equal[known].sum())
    difference = difference.value[known]
    ends = " to ".join(dict.fromkeys(f"{d:+.2f}" for d in (difference.min(), difference.max())))
    return Finding(
        share(agree, known.sum()),
        f"they agree at {agree} of {known.sum()} loads, A_r(s) less boxes {ends}",
    )


@of_the_area
def dimension_rises_by_area(joint: Joint) -> Finding:
    """Delta_sigma from A_r(s) against the logarithm of F, where it is determined."""
    line = _over_load(joint.states("scaling")).line
    if not line.slope.known:
        return Finding(UNDETERMINED, _too_few(line))
    return Finding(by_sign(line.slope, rising=True), _by_decade(line), f"{line.n} loads")


def dimension_rises_by_boxes(joint: Joint) -> Finding:
    """Delta_sigma from box counts against the logarithm of F, beside as many random nodes.

    More nodes fill more boxes wherever they lie: a rise that random nodes have too is no change of
    geometry.
    """
    states = joint.states("domains")
    trend = _over_load(states, states["delta_sigma_random"].values)
    if not trend.line.slope.known:
        return Finding(UNDETERMINED, _too_few(trend.line))
    verdict = by_sign(trend.line.slope, rising=True)
    if verdict == HOLDS and not trend.departure.slope.low > 0:
        verdict = PARTLY
    return Finding(
        verdict,
        f"{_by_decade(trend.line)}, less that of as many random nodes "
        f"{trend.departure.slope:+z.2f}",
        f"{trend.line.n} loads; more nodes fill more boxes wherever they lie, so a rise no faster "
        "than that of random nodes holds in part",
    )


def dimension_spans_all(joint: Joint) -> Finding:
    """Smallest and largest Delta_sigma by box counts, near 0 and near 2 by their intervals."""
    states = joint.states("domains")
    nodes = joint.states("closure")["nodes"].values
    delta = Estimate.read(states, "delta_sigma")
    known = np.flatnonzero(delta.known)
    if not known.size:
        return Finding(UNDETERMINED, "no load with a dimension by boxes")
    touching = nodes[known[[np.argmin(delta.value[known]), np.argmax(delta.value[known])]]]
    return span_finding(
        delta[known],
        states["delta_sigma_random"].values[known],
        joint.forces[known] / joint.area,
        f"{int(touching[0])} to {int(touching[1])} nodes: near the lower end one more changes the "
        f"answer{by_design(joint)}",
    )


def span_finding(delta: Estimate, random: np.ndarray, pressures: np.ndarray, note: str) -> Finding:
    """Verdict on a Delta_sigma that is to go from near 0 to near 2 as the load grows.

    It does not where it stays below the upper end, by the intervals of its largest value and of
    that under the heaviest load. Where random nodes are not near 0 at the lower end the loads are
    not light enough, and that end is not missed.

    Parameters
    ----------
    delta : Estimate
        (n,), each with a value.
    random : (n,) ndarray
        That of random nodes.
    pressures : (n,) ndarray
        MPa, ascending.
    note : str
        Begins with a small letter.
    """
    least, most = int(np.argmin(delta.value)), int(np.argmax(delta.value))
    lower, upper = delta[least], delta[most]
    reached = int(lower.high <= NEAR_POINTS) + int(upper.low >= NEAR_FULL)
    begins_late = lower.low > NEAR_POINTS >= random[least]
    verdict = (FAILS if begins_late else UNDETERMINED, PARTLY, HOLDS)[reached]
    if max(upper.high, delta.high[-1]) < NEAR_FULL:
        verdict = FAILS
    return Finding(
        verdict,
        f"by boxes {lower:.2f} to {upper:.2f} up to {pressures[-1]:.3g} MPa",
        note,
    )


def by_design(joint: Joint) -> str:
    """Note on the upper end where a hardness caps the pressure; empty without one."""
    capped = np.isfinite(joint.settings["material"]["hardness"])
    return "; at full yield it is 2 by construction" if capped else ""


def size_effect_follows(joint: Joint) -> Finding:
    """Verdicts of the size test under the study's loads, with either estimate of Delta_sigma.

    They are of both forms together: A_r/A_0 over b at equal sigma_0 first, then eq. 6's own form.
    """
    test = joint["size_test"].sel(estimator=list(ESTIMATES))
    test = test.isel(normal_force=~test["beyond_study"].values.astype(bool))
    exponents = Estimate.read(test, "area_exponent")
    known = np.isfinite(exponents.width)
    if not known.any():
        return Finding(UNDETERMINED, "at no load do two sizes of window hold enough nodes")
    narrowest = int(np.nanargmin(exponents.width))
    best, exponent = test.isel(normal_force=narrowest), exponents[narrowest]
    wanted = zip(ESTIMATES.values(), best["predicted_slope"].values, strict=True)
    numbers = (
        f"A_r/A_0 ~ b^x, x = {exponent:z.2f} at "
        f"{float(best['nominal_pressure']):.3g} MPa, eq. 6 has "
        + ", ".join(f"{slope:.2f} {by}" for by, slope in wanted if np.isfinite(slope))
    )
    decided = test["decides"].values
    if not decided.any() and _beyond(exponent, Estimate.read(best, "predicted_slope")):
        return Finding(
            FAILS, numbers, "the interval of x excludes every exponent that eq. 6 allows"
        )
    if not decided.any():
        return Finding(UNDETERMINED, numbers, _why_open(test["reason"].values[:, known].ravel()))
    agree = (test["verdict"] == AGREES).values
    words = ", ".join(
        f"{agree[i].sum()} of {decided[i].sum()} loads {by}"
        if decided[i].any()
        else f"no load {by}"
        for i, by in enumerate(ESTIMATES.values())
    )
    alone = test["slope_verdict"]
    own = (
        f"that form alone agrees in {int((alone == AGREES).sum())} of "
        f"{int(alone.isin(DECIDED).sum())} cases"
    )
    return Finding(
        share(int(agree.sum()), int(decided.sum())),
        numbers,
        f"x agrees with eq. 6 at {words}, of loads with narrow enough intervals, on windows within "
        f"one joint; sigma_0 over b at equal sigma* must agree there, too; {own}",
    )


def _beyond(exponent: Estimate, predicted: Estimate) -> bool:
    """True if an exponent lies outside every predicted one, by the intervals of both."""
    apart = (exponent.low > predicted.high) | (exponent.high < predicted.low)
    known = np.isfinite(predicted.width)
    return bool(known.any() and apart[known].all())


def _why_open(reasons):
    """Reasons why no load is conclusive about eq. 6, the most frequent first."""
    counts = Counter(str(reason) for reason in reasons).most_common()
    why = "; ".join(f"{reason} ({n})" for reason, n in counts)
    return f"the intervals are too wide at every load; {len(reasons)} cases (load, estimate): {why}"


def larger_domains_are_less_dense(joint: Joint) -> Finding:
    """Exponent of corrected A_r/A_0 against window size at one nominal pressure."""
    windows = joint.state("windows")
    exponent = Estimate.read(windows, "area_exponent")
    if not exponent.known:
        return Finding(UNDETERMINED, "fewer than two sizes of window with 30 nodes in contact")
    pressure = float(windows["nominal_pressure"])
    return Finding(
        beyond_margin(exponent, "larger_domains_are_less_dense", rising=False),
        f"x = {exponent:z.2f}",
        f"A_r/A_0 ~ b^x at {pressure:.3g} MPa",
    )


def strength_falls_with_size(joint: Joint) -> Finding:
    """Exponents of shear strength against window size, at equal v/b and all loads.

    Where a sub-window's angle is truncated its strength is no result, and the size has no strength:
    what is left of the sizes decides, if three are.
    """
    windows = joint["windows"]
    order = ("share", "normal_force")
    exponent = Estimate.read(windows.transpose(*order, ...), "strength_at_equal_v_over_b_exponent")
    value, low, high = exponent.ends
    sizes = windows["strength_at_equal_v_over_b"].notnull().sum("part").transpose(*order).values
    truncated = (
        (windows["truncated_fraction_at_equal_v_over_b"] > 0).any("part").transpose(*order).values
    )
    cases = sizes >= MIN_POINTS
    if not cases.any():
        return Finding(UNDETERMINED, "no v/b has three sizes of window to compare")
    known = cases & ~truncated & np.isfinite(value)
    exponents = _exponents(value, low, high, known)
    if 2 * known.sum() <= cases.sum():
        bounded = int((cases & truncated).sum())
        bound = f"a strength lies at its bound in {bounded} of {cases.sum()} cases (v/b, F)"
        return Finding(UNDETERMINED, bound, exponents)
    falls, rises = int((high[known] < 0).sum()), int((low[known] > 0).sum())
    if falls == known.sum() or rises == known.sum():
        return Finding(HOLDS if falls else FAILS, exponents)
    return Finding(PARTLY if falls else UNDETERMINED, exponents)


def _exponents(value, low, high, known):
    """The exponents of strength in words; none where there is none."""
    if not known.any():
        return ""
    ends = " to ".join(dict.fromkeys(f"{e:.2f}" for e in (value[known].min(), value[known].max())))
    falls, rises = int((high[known] < 0).sum()), int((low[known] > 0).sum())
    return (
        f"tau ~ b^x at equal v/b, x = {ends}, falls beyond its interval in {falls} of "
        f"{known.sum()} cases, rises in {rises}"
    )


def _over_load(states, random=np.nan):
    """Trend of Delta_sigma with log F, and that less the one of random nodes.

    The interval of each slope is that of the line and that of the values in quadrature.
    """
    delta = Estimate.read(states, "delta_sigma")
    forces, known = states["normal_force"].values, np.isfinite(delta.width)
    trend = pressure_trend(forces, np.where(known, delta.value, np.nan), random)
    of_values = slope_error(np.log10(forces[known]), delta.width[known] / 2)
    return trend._replace(
        line=_widened(trend.line, of_values), departure=_widened(trend.departure, of_values)
    )


def _widened(line, half):
    """A line with the interval of its slope widened by another error."""
    slope = line.slope
    whole = np.hypot(slope.high - slope.value, half)
    return line._replace(slope=replace(slope, low=slope.value - whole, high=slope.value + whole))


def _by_decade(line):
    """The slope of a line over the decades of F, with its interval."""
    return f"{line.slope:+z.2f} a decade of F"


def _too_few(line):
    """Why there is no line."""
    return f"determined at {line.n} of the {MIN_POINTS} loads needed"
