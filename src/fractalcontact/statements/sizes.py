"""Statements of the paper on sizes: roughness, closure, voids and angles (sects. 3 and 7)."""

from collections.abc import Sequence

import numpy as np

from ..core.claims import all_claims
from ..core.estimate import Estimate
from ..core.fitting import slope_with_bounds
from ..core.text import compact, number
from ..core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from .evidence import Evidence, of_a_kind
from .findings import (
    Finding,
    Joint,
    beyond_margin,
    difference_of,
    margin_words,
    of_unchosen_dilatancy,
    trend_over_sizes,
    within_margin,
)


def roughness_grows_with_size(joint: Joint) -> Finding:
    """Exponent of sigma_z of the lower face against the size of sub-windows, less 3 - Delta_g.

    sigma_z is the rms height about the own plane of a sub-window, fitted below a roll-off. The
    claim holds where the interval of the difference lies within the margin.
    """
    name, laws = "roughness_grows_with_size", joint["windows"]
    exponent, expected = (Estimate.read(laws, of) for of in ("face_hurst", "expected_hurst"))
    less = difference_of(exponent, expected)
    if not np.isfinite(less.width):
        return Finding(UNDETERMINED, "no exponent of sigma_z, or no Delta_g, with an interval")
    ends = [float(laws[f"face_hurst_b_{end}"]) for end in ("min", "max")]
    return Finding(
        within_margin(less, all_claims()[name].margin),
        f"sigma_z ~ b^x, x = {number(exponent)}; H = 3 - Delta_g = {number(expected)}",
        f"b = {compact(ends[0], 2)} to {compact(ends[1], 2)} mm; {margin_words(name)}",
    )


@of_a_kind
def closure_grows_as_roughness(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of the closure against b less that of sigma_z of the same sub-windows.

    The closure counts from first touch, at equal nominal pressure. The claim holds where the
    interval of the difference lies within the margin.
    """
    name = "closure_grows_as_roughness"
    less = evidence.closure_beyond_roughness()
    if not less.known:
        return Finding(UNDETERMINED, "too few nodes in contact in sub-windows of two sizes")
    closure, roughness = (
        evidence.size_exponent(f"{of}_exponent") for of in ("closure", "roughness")
    )
    return Finding(
        within_margin(less, all_claims()[name].margin),
        f"closure ~ b^x, x = {number(closure)}; sigma_z ~ b^x, x = {number(roughness)}; they "
        f"differ by {number(less, 2, '+')}",
        f"{evidence.reference}; {margin_words(name)}",
    )


@of_a_kind
def voids_grow_with_size(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of the largest void against the size of sub-windows, at equal nominal pressure.

    The void is the largest disc about a node of the window that holds no contact. The claim holds
    where the interval of the exponent lies above the margin.
    """
    exponent = evidence.size_exponent("void_exponent")
    numbers = f"diameter of the largest void ~ b^x, x = {number(exponent)}"
    source = evidence.reference
    return trend_over_sizes("voids_grow_with_size", exponent, numbers, source, rising=True)


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
        f"{f'; bounds from above in {bounded} cases with truncated angles' if bounded else ''}",
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
    cases = (slope_with_bounds(doublings, angle[i], truncated[i] > 0) for i in np.flatnonzero(fitted))
    return [slope for slope in cases if slope.known]
