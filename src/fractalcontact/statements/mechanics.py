"""What the paper says of closure, contact area and dilatancy (sect. 5, Figs. 4 to 7)."""

import numpy as np

from ..core.fitting import fit_line
from .findings import (
    FAILS,
    HOLDS,
    LOOSELY,
    NEARLY,
    PARTLY,
    UNKNOWN,
    Finding,
    Joint,
    level,
    no_offsets,
    share,
    trend,
)

#: Rms misfit up to which a closure curve is called a hyperbola, of the largest closure.
GOOD_FIT = 0.02
#: A rank correlation is believed below this probability of chance.
CHANCE = 0.05


def compliance_rises_at_first(joint: Joint) -> Finding:
    """Closure against offset up to the correlation length, as a power of v."""
    return trend(joint.offset, joint.closure, joint.initial, "w_int", rising=True)


def curves_overlap(joint: Joint) -> Finding:
    """Spread of the closure beyond the correlation length."""
    return level(joint.closure[joint.between], "w_int", joint.offset[joint.between])


def compliance_rises_again(joint: Joint) -> Finding:
    """Closure where the faces no longer correlate, against that at the offsets just before.

    Those are the ones beyond the correlation length or, if none was solved there, the last within.
    """
    before = joint.between
    if not before.any() and joint.initial.any():
        before = joint.offset == joint.offset[joint.initial].max()
    if not joint.unrelated.any() or not before.any():
        return Finding(UNKNOWN, no_offsets("both before and after the faces lose correlation"))
    change = joint.closure[joint.unrelated].mean() / joint.closure[before].mean() - 1
    verdict = HOLDS if change > NEARLY else PARTLY if change > 0 else FAILS
    ends = joint.offset[before].max(), joint.offset[joint.unrelated].min()
    return Finding(
        verdict, f"w_int {100 * change:+.0f} % from v <= {ends[0]:.3g} to >= {ends[1]:.3g} mm"
    )


def closure_is_hyperbolic(joint: Joint) -> Finding:
    """Misfit of the hyperbolas, and how many there are."""
    finest = joint.stages["closure"].sel(direction=joint.direction)
    finest = finest.sel(resolution=finest["resolution"].min())
    slid = joint.offset > 0
    misfit = finest["hyperbola_misfit"].values[slid]
    fitted = np.isfinite(misfit)
    if not fitted.any():
        return Finding(FAILS, f"none of {slid.sum()} curves could be fitted")
    good = int((misfit[fitted] <= GOOD_FIT).sum())
    return Finding(
        share(good, slid.sum()),
        f"{good} of {slid.sum()} curves within {100 * GOOD_FIT:g} % rms; misfits "
        f"{100 * misfit[fitted].min():.1f} to {100 * misfit[fitted].max():.1f} %",
    )


def area_is_linear(joint: Joint) -> Finding:
    """Exponent m of A_r ~ F^m at every offset."""
    law = joint.stages["area"].sel(direction=joint.direction)
    exponent = law["exponent"].values
    exponent = exponent[np.isfinite(exponent)]
    if not exponent.size:
        return Finding(UNKNOWN, "no law of the area could be fitted")
    near = int((np.abs(exponent - 1) <= NEARLY).sum())
    return Finding(
        share(near, exponent.size),
        f"A_r ~ F^m, m = {exponent.min():.2f} to {exponent.max():.2f}; "
        f"{near} of {exponent.size} within {NEARLY:g} of 1",
    )


def area_falls(joint: Joint) -> Finding:
    """Contact area against offset, as a power of v."""
    area = joint.at_load("closure", "area_share")
    return trend(joint.offset, area, joint.offset > 0, "A_r", rising=False)


def area_settles(joint: Joint) -> Finding:
    """Spread of the contact area beyond the correlation length."""
    beyond = joint.between | joint.unrelated
    area = joint.at_load("closure", "area_share")
    return level(area[beyond], "A_r", joint.offset[beyond])


def composite_dimension_rises(joint: Joint) -> Finding:
    """Delta_g of the composite topography against offset."""
    dimension = joint.stages["joints"]["composite_dimension"].values
    slid = joint.offset > 0
    v, dimension = joint.offset[slid], dimension[slid]
    line = fit_line(np.log(v), dimension)
    if not np.isfinite(line.slope):
        return Finding(UNKNOWN, no_offsets("three"))
    verdict = HOLDS if line.slope_low > 0 else PARTLY if line.slope > 0 else FAILS
    decade = np.log(10)
    return Finding(
        verdict,
        f"Delta_g {dimension[0]:.2f} at v = {v[0]:.3g} mm, {dimension[-1]:.2f} at {v[-1]:.3g} mm; "
        f"{decade * line.slope:+.2f} [{decade * line.slope_low:+.2f}, "
        f"{decade * line.slope_high:+.2f}] a decade of v",
    )


def compliance_goes_with_dimension(joint: Joint) -> Finding:
    """Rank correlation of the closure with Delta_g of the composite topography."""
    from scipy import stats  # slow to import, and used nowhere else

    dimension = joint.stages["joints"]["composite_dimension"].values
    usable = np.isfinite(dimension) & np.isfinite(joint.closure) & (joint.offset > 0)
    if usable.sum() < 4:
        return Finding(UNKNOWN, no_offsets("four"))
    rank, chance = stats.spearmanr(dimension[usable], joint.closure[usable])
    verdict = PARTLY if rank > 0 else FAILS
    verdict = HOLDS if rank > 0 and chance < CHANCE else verdict
    return Finding(verdict, f"Spearman's rank correlation {rank:+.2f} over {usable.sum()} offsets")


def dilatancy_flattens(joint: Joint) -> Finding:
    """Change of the rigid dilatancy over the second half of the offsets, by direction."""
    means, changes = _plateaus(joint.stages["joints"])
    if not changes.size:
        return Finding(UNKNOWN, no_offsets("three rigid"))
    flat = int((np.abs(changes) <= NEARLY).sum())
    return Finding(
        share(flat, changes.size),
        f"{flat} of {changes.size} directions change by at most {100 * NEARLY:g} % over the second "
        f"half of v ({100 * changes.min():+.0f} to {100 * changes.max():+.0f} %); mean level "
        f"{means.min():.2f} to {means.max():.2f} mm",
    )


def dilatancy_is_anisotropic(joint: Joint) -> Finding:
    """Difference of the rigid dilatancy among directions, over the last quarter of the offsets."""
    v = joint.stages["joints"]["rigid_offset"].values
    opened = joint.stages["joints"]["rigid_dilatancy"].values[:, v >= 0.75 * v[-1]].mean(axis=1)
    if opened.size < 2:
        return Finding(UNKNOWN, "fewer than two directions")
    spread = np.ptp(opened) / opened.mean()
    verdict = HOLDS if spread > LOOSELY else PARTLY if spread > NEARLY else FAILS
    return Finding(
        verdict,
        f"over the last quarter of v the directions differ by {100 * spread:.0f} % of their mean "
        f"({opened.min():.2f} to {opened.max():.2f} mm)",
    )


def domains_cluster(joint: Joint) -> Finding:
    """Morisita's index of the contact domains against offset, as a power of v."""
    index = joint.at_load("domains", "morisita")
    return trend(joint.offset, index, joint.offset > 0, "Morisita's index", rising=True)


def no_correlation_is_left(joint: Joint) -> Finding:
    """Correlation of the faces at the largest offset solved."""
    limit = float(joint.stages["joints"]["correlation_limit"])
    v = joint.stages["joints"]["rigid_offset"].values
    correlation = joint.of_direction("face_correlation")[np.argmin(np.abs(v - joint.offset[-1]))]
    numbers = f"correlation {correlation:+.2f} at v = {joint.offset[-1]:.3g} mm"
    if not np.isfinite(limit):
        return Finding(UNKNOWN, f"{numbers}; the window is too small to tell it from chance")
    verdict = HOLDS if correlation <= limit else FAILS
    return Finding(verdict, f"{numbers}, chance alone gives up to {limit:.2f}")


def larger_samples_close_more(joint: Joint) -> Finding:
    """Exponent of w_int against window size, at every offset."""
    windows = joint.stages["windows"]
    load = int(np.argmin(np.abs(windows["normal_force"].values - joint.force)))
    slid = windows["offset"].values > 0
    exponent, low = (
        windows[f"closure_exponent{end}"].isel(normal_force=load).values[slid]
        for end in ("", "_low")
    )
    known = np.isfinite(exponent)
    if not known.any():
        return Finding(UNKNOWN, "fewer than three sizes of window")
    sure = int((low[known] > 0).sum())
    return Finding(
        HOLDS if sure == known.sum() else PARTLY if np.mean(exponent[known]) > 0 else FAILS,
        f"w_int ~ b^e, e = {exponent[known].min():.2f} to {exponent[known].max():.2f}; above zero "
        f"beyond its interval at {sure} of {known.sum()} offsets",
    )


def _plateaus(joint):
    """Mean level (mm) and relative change of the rigid dilatancy over the second half of v."""
    v = joint["rigid_offset"].values
    second = v >= v[-1] / 2
    means, changes = [], []
    for opened in joint["rigid_dilatancy"].values:
        line = fit_line(v[second], opened[second])
        if np.isfinite(line.slope):
            means.append(opened[second].mean())
            changes.append(line.slope * (line.x_max - line.x_min) / means[-1])
    return np.array(means), np.array(changes)


#: Figure, claim in our words, and what judges it.
STATEMENTS = (
    (
        "4, 5",
        "In the first stages of sliding the joint becomes more compliant with v",
        compliance_rises_at_first,
    ),
    ("4, 5", "Beyond a certain v the closure curves overlap", curves_overlap),
    (
        "4, 5",
        "At very large v, with no correlation left, compliance increases again",
        compliance_rises_again,
    ),
    ("4, 5", "The closure curves are hyperbolas with an asymptote", closure_is_hyperbolic),
    ("4, 5", "The dimension of the composite topography rises with v", composite_dimension_rises),
    (
        "4, 5",
        "The higher that dimension, the more compliant the joint",
        compliance_goes_with_dimension,
    ),
    ("4, 5", "Larger samples of a joint close more", larger_samples_close_more),
    ("4, 5", "The real contact area is nearly proportional to F", area_is_linear),
    ("4-7", "At fixed F the real contact area falls as v rises", area_falls),
    ("7", "Beyond a certain v the real contact area stays the same", area_settles),
    ("6, 7", "Rigid dilatancy reaches a plateau in every direction", dilatancy_flattens),
    ("7", "Rigid dilatancy is markedly anisotropic", dilatancy_is_anisotropic),
    ("6, 7", "Contact domains become less homogeneous with v and cluster", domains_cluster),
    ("6", "At the largest v no correlation of the faces is left", no_correlation_is_left),
)
