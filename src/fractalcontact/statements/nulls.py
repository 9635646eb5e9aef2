"""Statements judged against a rival: closure laws, null models of the domain, isotropy."""

import numpy as np
from scipy import special

from ..core.claims import all_claims
from ..core.determined import differ_together, differs
from ..core.directions import slides
from ..core.estimate import Estimate
from ..core.limits import CONFIDENCE, LARGEST_MISFIT, LOOSELY, NEARLY
from ..core.text import compact, loads_of, number
from ..core.verdicts import (
    FAILS,
    LIKE_RANDOM,
    UNDETERMINED,
)
from ..domain import departure
from .evidence import Evidence, at_reference, of_a_kind
from .findings import Finding, Joint, margin_words, share, within_margin
from .local_slopes import one_slope

#: Dimensions whose difference from the bearing-area cut's shows whether the two are related.
_DIMENSIONS = ("delta_sigma", "correlation_dimension")

#: Least probability that is written.
_LEAST_P = 1e-6

#: Null models of a contact domain, in words.
_NULLS = {"random": "random nodes", "cut": "bearing-area cut"}


def closure_is_hyperbolic(joint: Joint) -> Finding:
    """Misfits of the hyperbola and of the logarithm, from the seating pressure on, at every offset.

    The paper fits hyperbolas to find asymptotes, which the logarithm lacks. The hyperbola is zero
    at the seat, which the logarithm, of two free constants, need not be. The claim holds where
    the hyperbola misses every curve by 5 % rms or less and by less than the logarithm, and in part
    where it does so at some offsets.
    """
    curves = joint.along("closure")
    curves = curves.sel(resolution=curves["resolution"].min(), offset=joint.offsets > 0)
    hyperbola, logarithm = (
        curves[f"seated_{law}_misfit"].values for law in ("hyperbola", "logarithm")
    )
    fitted = np.isfinite(hyperbola)
    count = int(fitted.sum())
    if not count:
        return Finding(UNDETERMINED, "no closure curve has enough loads above its seating pressure")
    hyperbola, logarithm = hyperbola[fitted], logarithm[fitted]
    close = hyperbola <= LARGEST_MISFIT
    wins = int((close & (hyperbola < logarithm)).sum())
    first = np.nanmedian(curves["hyperbola_misfit"].values[fitted])
    ends = " to ".join(
        dict.fromkeys(compact(100 * end, 2) for end in (hyperbola.min(), hyperbola.max()))
    )
    return Finding(
        share(wins, count),
        f"from the seat the hyperbola misses by {ends} % rms, by less than the logarithm at "
        f"{wins or 'none'} of {count} offsets",
        f"from first contact it misses by {compact(100 * first, 2)} % (median)",
    )


@of_a_kind
def domains_are_fractal(joint: Joint, evidence: Evidence) -> Finding:
    """Local slopes of the box counts, which one power law has over a decade of box sides.

    The claim holds where one slope fits them, and in part where they vary by up to ±0.25. Where as
    many random nodes have the same slopes the counts could not have shown a structure, and the
    claim is undetermined. The bearing-area cut explains, and changes no verdict.
    """
    state = at_reference(joint, evidence)
    null = str(state["null_verdict"].item())
    if null == departure.UNDETERMINED:
        return Finding(UNDETERMINED, str(state["null_reason"].item()))
    verdict, slopes, *_ = one_slope(state)
    return Finding(
        UNDETERMINED if null == LIKE_RANDOM and verdict != FAILS else verdict,
        slopes,
        evidence.reference,
        explanation=f"{null}; "
        + "; ".join(_departure_words(state, name, words) for name, words in _NULLS.items()),
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


@of_a_kind
def domains_are_isotropic(joint: Joint, evidence: Evidence) -> Finding:
    """Exponent of occupied intervals across the sliding less that along it, with the margin.

    Intervals of rows and of columns are counted over their length. Isotropic scaling gives both the
    same exponent.
    """
    name = "domains_are_isotropic"
    difference = evidence.interval_difference()
    if not difference.known:
        return Finding(UNDETERMINED, "too few nodes in contact for exponents along both axes")
    ways = "across sliding less that along it"
    if not slides(joint.settings["opposite"]):
        ways = "along y less that along x"
    return Finding(
        within_margin(difference, all_claims()[name].margin),
        f"the exponent of occupied intervals {ways} is {number(difference, 2, '+')}",
        f"{evidence.reference}; {margin_words(name)}",
    )
