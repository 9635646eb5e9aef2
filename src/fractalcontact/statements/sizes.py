"""Statements of the paper on sizes: roughness, closure, voids and angles (sects. 3 and 7)."""

from collections.abc import Sequence

import numpy as np

from ..core.claims import all_claims
from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.text import compact, number
from ..core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from .evidence import Evidence, of_a_kind
from .findings import (
    Finding,
    Joint,
    beyond_margin,
    difference_of,
    margin_words,
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


def friction_angle_falls_with_size(joint: Joint) -> Finding:
    """Change of the limit slope angle atan(tau/sigma_0) per doubling of b, at equal v/b.

    Every v/b and load with three sizes or more is a case, if no angle was truncated. The claim
    holds where the angle falls by more than the margin in every case, in part where it falls in
    some, and fails where it falls in none and some case shows no fall beyond the margin.
    """
    name = "friction_angle_falls_with_size"
    slopes = _angle_slopes(joint)
    if not slopes:
        return Finding(
            UNDETERMINED, "no v/b has three sizes of window whose angles are not truncated"
        )
    margin = all_claims()[name].margin
    verdicts = [beyond_margin(slope, margin, rising=False) for slope in slopes]
    falls = verdicts.count(HOLDS) + verdicts.count(PARTLY)
    cases, no_fall = len(slopes), verdicts.count(FAILS)
    verdict = PARTLY if falls else FAILS if no_fall else UNDETERMINED
    values = [float(slope.value) for slope in slopes]
    ends = " to ".join(
        dict.fromkeys(f"{number(end, 1, '+')}" for end in (min(values), max(values)))
    )
    return Finding(
        HOLDS if verdicts.count(HOLDS) == cases else verdict,
        f"the angle falls at equal v/b in {falls or 'none'} of {cases} cases",
        f"it changes by {ends} degrees per doubling of b; margin {compact(margin, 6)} degree"
        f"{f'; it surely does not fall in {no_fall}' if no_fall else ''}",
    )


def _angle_slopes(joint: Joint) -> Sequence[Estimate]:
    """Slopes of the limit slope angle over log2 b, degrees, of the cases without truncation."""
    laws = joint["windows"]
    order = ("share", "normal_force", "part")
    angle = laws["limit_slope_angle"].transpose(*order).values
    truncated = laws["truncated_fraction_at_equal_v_over_b"].transpose(*order).values
    exponents = laws["strength_at_equal_v_over_b_exponent"]
    fitted = np.isfinite(exponents.transpose(*order[:2]).values)
    doublings = np.log2(laws["side"].values)
    slopes = []
    for case in np.argwhere(fitted):
        at = tuple(case)
        counts = np.isfinite(angle[at])
        if not (truncated[at][counts] > 0).any():
            slope = fit_line(doublings, angle[at]).slope
            slopes += [slope] if slope.known else []
    return slopes
