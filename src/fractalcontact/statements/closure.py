"""Statements of the paper on closure and contact area (sects. 4 and 5, Figs. 4 and 5)."""

import numpy as np

from ..core.estimate import Estimate
from ..core.limits import NEARLY
from ..core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED
from .findings import (
    Finding,
    Joint,
    beyond_margin,
    level,
    no_offsets,
    of_the_area,
    trend,
    under_every_load,
)

#: Closure from first contact is an extreme of the sample; compliance is a property of the joint.
_COMPLIANCE = "compliance"


def compliance_rises_at_first(joint: Joint) -> Finding:
    """Compliance of the interface up to the correlation length, as a power of v."""
    return trend(joint.offsets, joint.compliance, joint.initial, _COMPLIANCE, rising=True)


def curves_overlap(joint: Joint) -> Finding:
    """Spread of the compliance of the interface beyond the correlation length, at every load."""
    v = joint.offsets[joint.between]

    def spread(force):
        return level(joint.compliance_under(force)[joint.between], _COMPLIANCE, v)

    return under_every_load(joint, spread)


def compliance_rises_again(joint: Joint) -> Finding:
    """Compliance where the faces no longer correlate, against that just before, at every load.

    Before are the offsets beyond the correlation length or, if none was solved there, the last
    within.
    """
    before = joint.between
    if not before.any() and joint.initial.any():
        before = joint.offsets == joint.offsets[joint.initial].max()
    return under_every_load(joint, lambda force: _rise(joint, force, before))


def _rise(joint, force, before):
    """Compliance at the offsets without correlation less that at the ones before, under a load."""
    compliance = joint.compliance_under(force)
    known = np.isfinite(compliance)
    before, after = before & known, joint.unrelated & known
    if not after.any() or not before.any():
        return Finding(UNDETERMINED, no_offsets("both before and after the faces lose correlation"))
    spread = joint.along("closure")["composite_spread"].values
    change, of_spread = (
        values[after].mean() / values[before].mean() - 1 for values in (compliance, spread)
    )
    ends = joint.offsets[before].max(), joint.offsets[after].min()
    return Finding(
        HOLDS if change > NEARLY else FAILS,
        f"compliance {100 * change:+.0f} %",
        f"from v <= {ends[0]:.3g} to >= {ends[1]:.3g} mm; sigma_z of the composite topography "
        f"{100 * of_spread:+.0f} %",
    )


def composite_dimension_rises(joint: Joint) -> Finding:
    """Delta_g of the composite topography against offset: fixed by where it is fitted.

    For lags h the variogram of z(x + v) - z(x) is twice the face's where h is far below v, whose
    dimension it then has at every v, and flat where h is far above v. A dimension fitted over a
    fixed range of lags falls as v passes through that range, whatever the joint.
    """
    joints = joint["joints"]
    dimension = joints["composite_dimension"].values
    known = np.isfinite(dimension) & (joint.offsets > 0)
    if not known.any():
        return Finding(
            ILL_POSED, "fixed by the range of lags fitted: flat above v, the face's below"
        )
    v, fitted = joint.offsets[known], dimension[known]
    low = float(joints["composite_fit_min"].min())
    high = float(joints["composite_fit_max"].max())
    return Finding(
        ILL_POSED,
        f"Delta_g {fitted[0]:.2f} at v = {v[0]:.3g} mm, {fitted[-1]:.2f} at {v[-1]:.3g} mm, for "
        f"lags of {low:.3g} to {high:.3g} mm",
        "the variogram of a difference is flat above v, and the face's own below it at every v",
    )


def compliance_goes_with_dimension(joint: Joint) -> Finding:
    """Compliance against a dimension that the range of the fit decides."""
    return Finding(
        ILL_POSED,
        "asks for the dimension of the row above",
        "a joint slid farther is more compliant since sigma_z grows",
    )


def larger_samples_close_more(joint: Joint) -> Finding:
    """Exponent of the compliance of the interface against the size of sub-windows."""
    windows = joint.state("windows")
    exponent = Estimate.read(windows, "compliance_exponent")
    if not exponent.known:
        return Finding(UNDETERMINED, "fewer than two sizes of window with ten nodes in contact")
    closure = float(windows["closure_exponent"])
    return Finding(
        beyond_margin(exponent, "larger_samples_close_more", rising=True),
        f"x = {exponent:z.2f}",
        f"compliance ~ b^x at {float(windows['nominal_pressure']):.3g} MPa; closure from first "
        f"contact, b^{closure:.2f}, grows as any largest value does",
    )


@of_the_area
def area_is_linear(joint: Joint) -> Finding:
    """Exponent m of A_r ~ F^m at every offset, A_r corrected for the perimeter."""
    law = joint.along("area")
    exponent = Estimate.read(law, "corrected_exponent")
    if not exponent.known.any():
        return Finding(UNDETERMINED, "no law of the area could be fitted")
    exponent = exponent[exponent.known]
    value = exponent.value
    near = int((np.abs(value - 1) <= NEARLY).sum())
    apart = int(((exponent.high < 1 - NEARLY) | (exponent.low > 1 + NEARLY)).sum())
    verdict = FAILS if apart == value.size else PARTLY if apart else HOLDS
    verdict = UNDETERMINED if not apart and 2 * near <= value.size else verdict
    ends = " to ".join(dict.fromkeys(f"{m:.2f}" for m in (value.min(), value.max())))
    return Finding(
        verdict,
        f"m = {ends}",
        f"A_r ~ F^m; {near} of {value.size} within {NEARLY:g} of 1, {apart} outside by their "
        "intervals",
    )


def area_falls(joint: Joint) -> Finding:
    """Contact area against offset, as a power of v."""
    return trend(joint.offsets, joint.area_fraction, joint.offsets > 0, "A_r", rising=False)


def area_settles(joint: Joint) -> Finding:
    """Spread of the contact area beyond the correlation length."""
    beyond = joint.between | joint.unrelated
    return level(joint.area_fraction[beyond], "A_r", joint.offsets[beyond])


def refinement_changes_little(joint: Joint) -> Finding:
    """Change of the closure from twice the scan's spacing to the spacing itself."""
    curves = joint.along("closure")
    curves = curves.sel(resolution=curves["resolution"].min())
    change = np.abs((curves["closure_spacing_error"] / curves["closure"]).values)
    change = change[np.isfinite(change)]
    if not change.size:
        return Finding(UNDETERMINED, "no state solved at two spacings")
    verdict = HOLDS if change.max() <= NEARLY else PARTLY if change.min() <= NEARLY else FAILS
    return Finding(
        verdict,
        f"closure changes by {100 * change.min():.0f} to {100 * change.max():.0f} % from 2 s to s",
        f"{change.size} states; closure counts from the highest point, which moves",
    )
