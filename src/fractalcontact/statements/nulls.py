"""Statements judged against a rival: closure laws, null models of the domain, isotropy."""

import numpy as np
from scipy import special

from ..core.claims import all_claims
from ..core.determined import differ_together, differs
from ..core.directions import slides
from ..core.estimate import Estimate
from ..core.limits import CONFIDENCE, LOOSELY, NEARLY
from ..core.text import compact, loads_of, number
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
from .evidence import Evidence, at_reference, of_a_kind
from .findings import Finding, Joint, share
from .local_slopes import one_slope

_OF_SLIDING = ("along sliding", "across")

#: Dimensions whose difference from the bearing-area cut's shows whether the two are related.
_DIMENSIONS = ("delta_sigma", "correlation_dimension")

#: Probabilities below this are not written.
_LEAST_P = 1e-6

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
        f"{compact(100 * np.nanmedian(curves[f'{law}_misfit'].values[slid][decided]), 2)} %"
        for law in ("hyperbola", "semi_logarithmic")
    )
    better = int((laws[decided] == HYPERBOLA).sum())
    return Finding(
        share(better, int(decided.sum())),
        f"the hyperbola fits better at {better or 'none'} of {decided.sum()} offsets",
        f"median rms misfits are {misfits} of the logarithm w_int = c + d ln sigma_0",
    )


@of_a_kind
def domains_are_fractal(joint: Joint, evidence: Evidence) -> Finding:
    """Local slopes of the box counts, compared with random nodes and with the bearing-area cut.

    The claim holds where the domain differs from both and has one slope over a decade of box sides.
    It holds in part where slopes vary by up to ±0.25, or where only random nodes differ.
    """
    state = at_reference(joint, evidence)
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
    """Box side of the largest departure from a null model, in words.

    One that is significant but smaller than the margin is none, and the words say so.
    """
    side, p = (float(state[f"local_slope_{null}_{name}"]) for name in ("side", "p"))
    if not np.isfinite(p):
        return f"{words}: not compared"
    place = int(np.argmin(np.abs(state["local_slope_side"].values - side)))
    slope, other = (float(state[name][place]) for name in ("local_slope", f"local_slope_{null}"))
    small = differs(p) and abs(slope - other) < NEARLY
    return (
        f"{words}: largest departure at r = {compact(side, 2)} mm, local slope "
        f"{number(slope)} against "
        f"{number(other)}, p "
        f"{f'= {compact(p, 2)}' if p >= _LEAST_P else f'< {compact(_LEAST_P, 6)}'}"
        f"{f' (significant, but smaller than {compact(NEARLY, 6)})' if small else ''}"
    )


@of_a_kind
def domains_differ_from_cuts(joint: Joint, evidence: Evidence) -> Finding:
    """Local slopes of the contact domain compared with those of the bearing-area cut, by load.

    Both sets coincide at a load where the intervals of all differences lie within the margin. They
    differ where a slope differs significantly (Holm's test) and by the margin or more. The claim
    fails if their dimensions surely differ by more than 0.25 at a load: they are then unrelated.
    """
    margin = all_claims()["domains_differ_from_cuts"].margin
    states = evidence.slopes()
    states = states.isel(normal_force=np.isfinite(states["local_slope_cut_p"].values))
    total = states.sizes["normal_force"]
    if not total:
        return Finding(UNDETERMINED, "no load at which domain and cut have local slopes to compare")
    apart, alike = _apart_and_alike(states, margin)
    beyond = [
        Estimate.read(states, f"{name}_cut_difference")
        for name in _DIMENSIONS
        if f"{name}_cut_difference" in states
    ]
    different = int(apart.sum())
    decided = different + int(alike.sum())
    verdict = share(different, decided) if decided else UNDETERMINED
    if any(_any_beyond(one, total) for one in beyond):
        verdict = FAILS
    less = states["delta_sigma_cut_difference"].values
    less = less[np.isfinite(less)]
    ends = (
        dict.fromkeys(number(end, 2, "+") for end in (less.min(), less.max())) if less.size else "-"
    )
    return Finding(
        verdict,
        f"local slopes differ from those of the cut at {loads_of(different, total)}",
        f"slopes coincide within {compact(margin, 6)} at "
        f"{loads_of(int(alike.sum()), total)}; Delta_sigma "
        f"minus that of the cut is {' to '.join(ends)}",
    )


def _apart_and_alike(states, margin):
    """Loads at which local slopes surely differ from the cut's, and at which all are its own."""
    difference = Estimate.read(states.transpose("normal_force", ...), "local_slope_cut_difference")
    departs = differ_together(states["local_slope_cut_p"].values)
    middle = states["local_slope_side"].values
    places = np.argmin(
        np.abs(middle - states["local_slope_cut_side"].values[:, np.newaxis]), axis=1
    )
    largest = np.abs(difference.value[np.arange(places.size), places])
    alike = np.fmax(np.abs(difference.low), np.abs(difference.high)).max(axis=1) <= margin
    return departs & (largest >= margin), alike


def _any_beyond(difference, loads):
    """True if a difference of dimensions is surely beyond a quarter, among this number of loads."""
    wider = special.ndtri((1 - CONFIDENCE) / 2 / loads) / special.ndtri((1 - CONFIDENCE) / 2)
    value, low, high = difference.ends
    low, high = value - wider * (value - low), value + wider * (high - value)
    return bool(((low > LOOSELY) | (high < -LOOSELY)).any())


def domains_are_isotropic(joint: Joint) -> Finding:
    """Probability of contact two nodes away from a node in contact, along the sliding and across.

    An isotropic domain has the same probability along both.
    """
    measures = joint["domain_measures"].sel(normal_force=joint.force, method="nearest")
    along, across = (
        Estimate.read(measures, f"contact_at_lag_{way}") for way in ("along", "across")
    )
    if not (along.known and across.known) or along.value + across.value == 0:
        return Finding(UNDETERMINED, "no two nodes in contact lie two nodes apart")
    ways = _OF_SLIDING if slides(joint.settings["opposite"]) else ("along x", "along y")
    numbers = (
        f"probability of contact two nodes from a node in contact: {number(along)} {ways[0]}, "
        f"{number(across)} {ways[1]}"
    )
    apart = max(along.low, across.low) > min(along.high, across.high)
    difference = abs(across.value - along.value) / (across.value + along.value)
    if apart:
        return Finding(FAILS if difference > LOOSELY else PARTLY, numbers)
    return Finding(HOLDS if difference <= NEARLY else UNDETERMINED, numbers)
