"""Statements of the paper on closure and contact area (sects. 4 and 5, Figs. 4 and 5)."""

import numpy as np

from ..core.claims import all_claims
from ..core.estimate import Estimate
from ..core.intervals import mean_difference
from ..core.limits import NEARLY
from ..core.text import compact, loads_of, number
from ..core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED
from .evidence import Evidence, of_a_kind
from .findings import (
    Finding,
    Joint,
    beyond_margin,
    level,
    margin_words,
    of_the_area,
    share,
    trend,
    under_every_load,
)

#: Relative difference between two pressures that are one.
ROUNDING = 1e-9

#: Closure from first contact is an extreme of the sample; compliance is a property of the joint.
_COMPLIANCE = "compliance"


def compliance_rises_at_first(joint: Joint) -> Finding:
    """Compliance of the interface up to the correlation length, as a power of v."""
    return trend(joint.offsets, joint.compliance, joint.initial, _COMPLIANCE, rising=True)


def curves_overlap(joint: Joint) -> Finding:
    """Range of the compliance of the interface beyond the correlation length, at every load.

    The claim holds where the range, with the solver's error, lies within the margin.
    """
    v, margin = joint.offsets[joint.between], all_claims()["curves_overlap"].margin

    def spread(force):
        compliance = joint.estimate_at_load("closure", "interface_compliance", force)
        return level(compliance[joint.between], _COMPLIANCE, v, margin)

    return under_every_load(joint, spread)


def compliance_rises_again(joint: Joint) -> Finding:
    """Change of the compliance as the correlation of the faces is lost, at every load.

    The mean logarithm over the offsets without correlation is compared with that over the offsets
    beyond the correlation length at which the faces still correlate (if there is none, the last one
    within that length). The claim holds where the interval lies above the margin.
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
        return Finding(UNDETERMINED, "no offset lies before the loss of correlation, or none after")
    spread = joint.along("closure")["composite_spread"].values
    change, of_spread = (
        mean_difference(np.log(values[after]), np.log(values[before])).mapped(np.expm1)
        for values in (compliance, spread)
    )
    name = "compliance_rises_again"
    ends = joint.offsets[before].max(), joint.offsets[after].min()
    percent = change.mapped(lambda end: 100 * end)
    return Finding(
        beyond_margin(change, all_claims()[name].margin, rising=True),
        f"compliance {number(percent, 0, '+')} %",
        f"from v = {compact(ends[0])} mm and less to {compact(ends[1])} mm and more; "
        f"{margin_words(name)}; "
        f"sigma_z of the composite topography {number(100 * of_spread.value, 0, '+')} %",
    )


def composite_dimension_rises(joint: Joint) -> Finding:
    """Delta_g of the composite topography against offset, which the fitted lags decide.

    At lags far below v the composite topography z(x + v) - z(x) has the dimension of the face. At
    lags far above v its variogram is flat. So the dimension fitted over given lags depends on v in
    the same way for every joint.
    """
    joints = joint["joints"]
    dimension = joints["composite_dimension"].values
    known = np.isfinite(dimension) & (joint.offsets > 0)
    if not known.any():
        return Finding(
            ILL_POSED, "the fitted lags decide it: the variogram is flat above v, the face's below"
        )
    v, fitted = joint.offsets[known], dimension[known]
    low = float(joints["composite_fit_min"].min())
    high = float(joints["composite_fit_max"].max())
    return Finding(
        ILL_POSED,
        f"Delta_g is {number(fitted[0])} at v = {compact(v[0])} mm and "
        f"{number(fitted[-1])} at {compact(v[-1])} mm, "
        f"over lags of {compact(low)} to {compact(high)} mm",
        "other lags would give other dimensions",
    )


def compliance_goes_with_dimension(joint: Joint) -> Finding:
    """Compliance against a dimension that the fitted lags decide."""
    return Finding(
        ILL_POSED,
        "it needs the dimension of the composite topography, which is ill-posed",
        "a joint slid farther is more compliant because sigma_z grows",
    )


@of_a_kind
def larger_samples_close_more(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of the compliance of the interface against the size of sub-windows.

    The claim holds where the interval lies above the margin, and fails where it lies below.
    """
    name = "larger_samples_close_more"
    exponent = evidence.size_exponent("compliance_exponent")
    if not exponent.known:
        return Finding(UNDETERMINED, "too few nodes in contact in sub-windows of two sizes")
    closure = float(joint.state("windows")["closure_exponent"])
    return Finding(
        beyond_margin(exponent, all_claims()[name].margin, rising=True),
        f"x = {number(exponent)}",
        f"compliance ~ b^x {evidence.reference}; {margin_words(name)}; closure from first touch "
        f"~ b^{number(closure)} in this specimen",
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
def area_falls(joint: Joint) -> Finding:
    """Contact area against offset, as a power of v."""
    return trend(joint.offsets, joint.area_fraction, joint.offsets > 0, "A_r", rising=False)


@of_the_area
def area_settles(joint: Joint) -> Finding:
    """Range of the contact area beyond the correlation length.

    The claim holds where the range, with the solver's error, lies within the margin.
    """
    beyond = joint.between | joint.unrelated
    area, error = (
        joint.at_load("closure", name)[beyond]
        for name in ("area_corrected", "area_corrected_error")
    )
    areas = Estimate(area, area - error, area + error)
    return level(areas, "A_r", joint.offsets[beyond], all_claims()["area_settles"].margin)


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
