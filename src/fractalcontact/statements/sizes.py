"""Statements of the paper on sizes: roughness, closure, voids and angles (sects. 3 and 7)."""

from collections.abc import Sequence

import numpy as np

from ..core.claims import all_claims
from ..core.estimate import Estimate
from ..core.fitting import slope_with_bounds
from ..core.text import compact, number
from ..core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from ..roughness.recommended import exponent_of_roughness, independent_dimension
from .evidence import Evidence, of_a_kind
from .findings import (
    Finding,
    Joint,
    beyond_margin,
    difference_of,
    margin_words,
    of_unchosen_dilatancy,
    share,
    trend_over_sizes,
    within_margin,
)


def roughness_grows_with_size(joint: Joint) -> Finding:
    """Exponent of sigma_z of the lower face against the size of windows, less 3 - Delta_g.

    sigma_z is the rms height about the own plane of a window. Delta_g must not come from sigma_z
    itself: it is the known one of a synthetic surface, and else that of the power spectrum. Both
    exponents are corrected for known bias and fitted over lags below a roll-off. The claim holds
    where the interval of the difference lies within the margin.
    """
    name, surface = "roughness_grows_with_size", joint["surface_dimension"]
    exponent = exponent_of_roughness(surface)
    expected = independent_dimension(surface).mapped(lambda delta: 3 - delta, falling=True)
    less = difference_of(exponent, expected)
    if not np.isfinite(less.width):
        return Finding(UNDETERMINED, "no exponent of sigma_z, or no independent Delta_g")
    known = np.isfinite(surface["known_dimension"])
    source = "known of this synthetic surface" if known else "by the power spectrum"
    ends = [float(surface[f"range_{end}"]) for end in ("min", "max")]
    words = f"{number(expected.value)}" if known else f"{number(expected)}"
    return Finding(
        within_margin(less, all_claims()[name].margin),
        f"sigma_z ~ b^x, x = {number(exponent)}; H = 3 - Delta_g = {words}, {source}",
        f"lags of {compact(ends[0], 2)} to {compact(ends[1], 2)} mm; {margin_words(name)}",
    )


@of_a_kind
def closure_grows_as_roughness(joint: Joint, evidence: Evidence) -> Finding:
    """Exponents of compliance and mean gap against b, and that of sigma_z, each compared with 1.

    All are of the same sub-windows at equal nominal pressure. A closure in proportion to b needs a
    sigma_z in proportion to b, and follows from it. So the claim holds where compliance and mean
    gap are proportional to b within the margin and sigma_z is, too, or where none is; in part where
    this is true of one of the two.
    """
    name = "closure_grows_as_roughness"
    margin = all_claims()[name].margin
    roughness = evidence.size_exponent("roughness_exponent")
    exponents = {
        words: evidence.size_exponent(of)
        for words, of in (("compliance", "compliance_exponent"), ("mean gap", "gap_exponent"))
    }
    exponents = {words: exponent for words, exponent in exponents.items() if exponent.known}
    if not (exponents and roughness.known):
        return Finding(UNDETERMINED, "too few nodes in contact in sub-windows of two sizes")
    similar = _proportional(roughness, margin)
    verdicts = [_proportional(exponent, margin) for exponent in exponents.values()]
    decided = [verdict for verdict in verdicts if verdict != UNDETERMINED]
    met = decided.count(similar)
    undecided = similar == UNDETERMINED or not decided
    return Finding(
        UNDETERMINED if undecided else share(met, len(decided)),
        f"sigma_z ~ b^x, x = {number(roughness)}; "
        + "; ".join(f"{words} {number(exponent)}" for words, exponent in exponents.items()),
        f"{evidence.reference}; in proportion to b: x = 1, {margin_words(name)}",
    )


def _proportional(exponent: Estimate, margin: float) -> str:
    """Verdict on an exponent of 1, within the margin."""
    return within_margin(exponent.mapped(lambda x: x - 1), margin)


@of_a_kind
def voids_grow_with_size(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of the largest void against the size of sub-windows, at equal nominal pressure.

    The void is the largest disc about a node that lies in the window and holds no contact. The
    claim holds where the interval of the exponent lies above the margin. That of as many random
    nodes explains, and changes no verdict: more places have a larger extreme.
    """
    exponent = evidence.size_exponent("void_exponent")
    numbers = f"diameter of the largest void ~ b^x, x = {number(exponent)}"
    source = evidence.reference
    finding = trend_over_sizes("voids_grow_with_size", exponent, numbers, source, rising=True)
    random = evidence.size_exponent("random_void_exponent")
    if not (exponent.known and random.known):
        return finding
    return finding._replace(explanation=f"among as many random nodes x = {number(random)}")


@of_unchosen_dilatancy
def friction_angle_falls_with_size(joint: Joint) -> Finding:
    """Change of the limit slope angle atan(tau/sigma_0) per doubling of b, at equal v/b.

    A tilted block presses its joint by its weight alone, so that the lightest load is judged; every
    v/b with three sizes or more is a case. An angle that is truncated is a lower bound: a change is
    then the largest that the bounds allow. The claim holds where the angle falls by more than the
    margin in every case, in part where it falls in some, and fails where it falls in none and some
    case shows no fall beyond the margin. At 45 degrees the margin is that of the strength.
    """
    name = "friction_angle_falls_with_size"
    slopes = _angle_slopes(joint)
    if not slopes:
        return Finding(UNDETERMINED, "no v/b has three sizes of window in three steps of sliding")
    margin = all_claims()[name].margin
    verdicts = [beyond_margin(slope, margin, rising=False) for slope in slopes]
    falls = verdicts.count(HOLDS) + verdicts.count(PARTLY)
    cases, no_fall = len(slopes), verdicts.count(FAILS)
    verdict = PARTLY if falls else FAILS if no_fall else UNDETERMINED
    values = [float(slope.value) for slope in slopes]
    ends = " to ".join(
        dict.fromkeys(f"{number(end, 1, '+')}" for end in (min(values), max(values)))
    )
    bounded = sum(bool(np.isneginf(slope.low)) for slope in slopes)
    lightest = joint["windows"]["nominal_pressure"].values.min()
    return Finding(
        HOLDS if verdicts.count(HOLDS) == cases else verdict,
        f"the angle falls at equal v/b in {falls or 'none'} of {cases} cases",
        f"it changes by {ends} degrees per doubling of b at {compact(lightest)} MPa; margin "
        f"{compact(margin, 6)} degrees"
        f"{f'; it surely does not fall in {no_fall}' if no_fall else ''}"
        f"{f'; bounds from above in {bounded} of them with truncated angles' if bounded else ''}",
    )


def _angle_slopes(joint: Joint) -> Sequence[Estimate]:
    """Slopes of the limit slope angle over log2 b, degrees, under the lightest load, by v/b."""
    laws = joint["windows"]
    laws = laws.isel(normal_force=int(np.argmin(laws["normal_force"].values)))
    laws = laws.transpose("share", "part", ...)
    angle, truncated = (
        laws[name].values for name in ("limit_slope_angle", "truncated_fraction_at_equal_v_over_b")
    )
    fitted = np.isfinite(laws["strength_at_equal_v_over_b_exponent"].values)
    doublings = np.log2(laws["side"].values)
    cases = (
        slope_with_bounds(doublings, angle[i], truncated[i] > 0) for i in np.flatnonzero(fitted)
    )
    return [slope for slope in cases if slope.known]
