"""Statements judged against a rival: closure laws, null models of the domain, isotropy."""

import numpy as np

from ..core.estimate import Estimate
from ..core.labels import loads_of
from ..core.limits import LOOSELY, NEARLY
from ..core.verdicts import (
    FAILS,
    HOLDS,
    HYPERBOLA,
    LIKE_CUT,
    LIKE_RANDOM,
    PARTLY,
    UNDECIDED,
    UNDETERMINED,
)
from ..domain import departure
from .findings import Finding, Joint, share
from .local_slopes import one_slope

_OF_SLIDING = ("along sliding", "across")

#: Dimensions whose difference from the bearing-area cut's shows whether the two are related.
_DIMENSIONS = ("delta_sigma", "correlation_dimension")

#: Null models of a contact domain, in words.
_NULLS = {"random": "random nodes", "cut": "bearing-area cut"}


def closure_is_hyperbolic(joint: Joint) -> Finding:
    """The closure law that fits better, hyperbola or semi-logarithmic, at every offset."""
    curves = joint.along("closure")
    curves = curves.sel(resolution=curves["resolution"].min())
    slid = joint.offsets > 0
    laws = curves["closure_law"].values.astype(str)[slid]
    decided = ~np.isin(laws, ("", UNDECIDED))
    if not decided.any():
        return Finding(UNDETERMINED, f"no law fits better at any of {slid.sum()} offsets")
    misfits = " against ".join(
        f"{100 * np.nanmedian(curves[f'{law}_misfit'].values[slid][decided]):.2g} %"
        for law in ("hyperbola", "semi_logarithmic")
    )
    better = int((laws[decided] == HYPERBOLA).sum())
    return Finding(
        share(better, int(decided.sum())),
        f"the better law at {better} of {decided.sum()} offsets",
        f"median rms misfit {misfits} of w_int = c + d ln sigma_0",
    )


def domains_are_fractal(joint: Joint) -> Finding:
    """Local slopes of the box counts, compared with random nodes, the cut and each other.

    A fractal set differs from random nodes, and has one slope over a decade of box sides or more.
    One that differs from the bearing-area cut as well is no mere cut at one height.
    """
    state = joint.state("domains")
    verdict = str(state["null_verdict"].item())
    if verdict == departure.UNDETERMINED:
        return Finding(UNDETERMINED, str(state["null_reason"].item()))
    found, slopes, *_ = one_slope(state)
    if verdict == LIKE_RANDOM:
        found = FAILS
    elif found == HOLDS and verdict == LIKE_CUT:
        found = PARTLY
    return Finding(
        found,
        f"{slopes}; {verdict}",
        "; ".join(_departure_words(state, null, words) for null, words in _NULLS.items()),
    )


def _departure_words(state, null, words):
    """Box side of the largest departure from a null model, in words."""
    side, p = (float(state[f"local_slope_{null}_{name}"]) for name in ("side", "p"))
    if not np.isfinite(p):
        return f"{words}: not compared"
    place = int(np.argmin(np.abs(state["local_slope_side"].values - side)))
    slope, other = (float(state[name][place]) for name in ("local_slope", f"local_slope_{null}"))
    return (
        f"{words}: largest departure at r = {side:.2g} mm, local slope {slope:.2f} against "
        f"{other:.2f}, p = {p:.2g}"
    )


def domains_differ_from_cuts(joint: Joint) -> Finding:
    """Elastic contact domain compared with the cut of the composite topography, over the loads.

    Not coincident where local slopes of the box counts differ; not related where the interval of
    the difference of the box-counting or correlation dimension lies beyond a quarter.
    """
    states = joint.states("domains")
    p = states["local_slope_cut_p"].values
    compared = np.isfinite(p)
    if not compared.any():
        return Finding(UNDETERMINED, "no load at which domain and cut have local slopes to compare")
    beyond = [Estimate.read(states, f"{name}_cut_difference")[compared] for name in _DIMENSIONS]
    unrelated = any(((one.low > LOOSELY) | (one.high < -LOOSELY)).any() for one in beyond)
    different, total = sum(map(departure.differs, p[compared])), int(compared.sum())
    verdict = FAILS if unrelated else share(different, total) if different else UNDETERMINED
    less = states["delta_sigma_cut_difference"].values[compared]
    less = less[np.isfinite(less)]
    ends = dict.fromkeys(f"{end:+.2f}" for end in (less.min(), less.max())) if less.size else "-"
    return Finding(
        verdict,
        f"local slopes differ from those of the cut at {loads_of(different, total)}",
        f"{total} loads compared; Delta_sigma less that of the cut {' to '.join(ends)}",
    )


def domains_are_isotropic(joint: Joint) -> Finding:
    """Contact at a lag from a node in contact, along the sliding and across it.

    What scales alike along both axes has the same probability along both.
    """
    measures = joint["domain_measures"].sel(normal_force=joint.force, method="nearest")
    along, across = (
        Estimate.read(measures, f"contact_at_lag_{way}") for way in ("along", "across")
    )
    if not (along.known and across.known) or along.value + across.value == 0:
        return Finding(UNDETERMINED, "no contact at that lag from another")
    ways = ("along x", "along y") if joint.settings["opposite"] == "flat" else _OF_SLIDING
    numbers = f"contact at a lag {along:.2f} {ways[0]}, {across:.2f} {ways[1]}"
    apart = max(along.low, across.low) > min(along.high, across.high)
    difference = abs(across.value - along.value) / (across.value + along.value)
    if apart:
        return Finding(FAILS if difference > LOOSELY else PARTLY, numbers)
    return Finding(HOLDS if difference <= NEARLY else UNDETERMINED, numbers)
