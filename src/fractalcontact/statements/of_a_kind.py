"""Statements of the paper on joints of a kind, judged on realisations of the kind.

Each rule has the name of its statement, as in the modules that judge one specimen, and reads the
stage ``ensemble``: means over the realisations with their 95 % intervals.
"""

from functools import wraps

import numpy as np
import xarray as xr

from ..core.claims import all_claims
from ..core.estimate import Estimate
from ..core.labels import loads_of
from ..core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from .findings import Finding, Joint, beyond_margin, by_sign, of_the_area
from .findings import share as share_of
from .scaling import ESTIMATES, by_design, span_finding


def _of_realisations(rule):
    """A rule whose finding says how many realisations it was judged on."""

    @wraps(rule)
    def judged(joint: Joint) -> Finding:
        found = rule(joint)
        realisations = f"{joint['ensemble'].sizes['realisation']} realisations"
        # A finding without a note has no number, but the reason why there is none.
        of = "mean of" if found.note else "in"
        return found._replace(
            numbers=f"{found.numbers}, {of} {realisations}", judged_on=realisations
        )

    return judged


def _mean(stage: xr.Dataset, name: str) -> Estimate:
    return Estimate.read(stage, f"{name}_mean")


def _reference(joint: Joint) -> xr.Dataset:
    """The ensemble under the reference load."""
    return joint["ensemble"].sel(normal_force=joint.force, method="nearest")


def delta_sigma_by_area(joint: Joint) -> Estimate:
    """Delta_sigma by A_r(s) under the reference load, mean over the realisations."""
    return _mean(_reference(joint), "delta_sigma_area")


def _pressure(joint: Joint, used: np.ndarray | None = None) -> str:
    """The reference pressure, or the range of pressures used, in words."""
    if used is None:
        return f"at {joint.force / joint.area:.3g} MPa"
    pressures = joint["ensemble"]["nominal_pressure"].values[used]
    return f"{pressures[0]:.3g} to {pressures[-1]:.3g} MPa" if pressures.size else "no load"


def _margin_words(name: str) -> str:
    return f"less than {all_claims()[name].margin:g} is called no change"


def _of_size(joint: Joint, name: str, exponent: str, law: str, *, rising: bool) -> Finding:
    """Verdict on an exponent over the size of sub-windows."""
    found = _mean(joint["ensemble"], exponent)
    if not found.known:
        return Finding(UNDETERMINED, "too few nodes in contact in sub-windows of two sizes")
    return Finding(
        beyond_margin(found, name, rising=rising),
        f"x = {found:z.2f}",
        f"{law} ~ b^x {_pressure(joint)}; {_margin_words(name)}",
    )


@_of_realisations
def larger_samples_close_more(joint: Joint) -> Finding:
    """Exponent of the compliance of the interface against the size of sub-windows, with a margin.

    The mean over realisations; an exponent whose interval stays below the margin is none.
    """
    name = "larger_samples_close_more"
    return _of_size(joint, name, "compliance_exponent", "compliance", rising=True)


@_of_realisations
def larger_domains_are_less_dense(joint: Joint) -> Finding:
    """Exponent of corrected A_r/A_0 against the size of sub-windows, with a margin.

    The mean over realisations; an exponent whose interval stays below the margin is none.
    """
    name = "larger_domains_are_less_dense"
    return _of_size(joint, name, "area_exponent", "A_r/A_0", rising=False)


@_of_realisations
def size_effect_follows(joint: Joint) -> Finding:
    """Exponent of corrected A_r/A_0 less that of eq. 6, Delta_sigma - 2, with a margin.

    Of each realisation with its own Delta_sigma, by both estimates, under the reference load. Eq. 6
    fails where the interval of the mean difference leaves out zero and some of it lies beyond the
    margin, and holds where all of it lies within.
    """
    reference = _reference(joint)
    name = "size_effect_follows"
    found = {words: _mean(reference, f"eq6_{key}") for key, words in ESTIMATES.items()}
    found = {words: one for words, one in found.items() if np.isfinite(one.width)}
    exponent = _mean(joint["ensemble"], "area_exponent")
    if not found:
        return Finding(UNDETERMINED, "no exponent beside a Delta_sigma of its own window")
    verdicts = [_equal(one, all_claims()[name].margin) for one in found.values()]
    alike = verdicts.count(HOLDS)
    verdict = UNDETERMINED if UNDETERMINED in verdicts else share_of(alike, len(verdicts))
    less = ", ".join(f"{one:+z.2f} {words}" for words, one in found.items())
    return Finding(
        verdict,
        f"A_r/A_0 ~ b^x, x = {exponent:z.2f}, x less eq. 6's exponent {less}",
        f"{_pressure(joint)}, on windows within one joint; {_margin_words(name)}",
    )


def _equal(found: Estimate, margin: float) -> str:
    """Verdict on a difference that is to be none."""
    if max(abs(found.low), abs(found.high)) <= margin:
        return HOLDS
    return FAILS if found.low > 0 or found.high < 0 else UNDETERMINED


@of_the_area
@_of_realisations
def estimates_agree(joint: Joint) -> Finding:
    """Delta_sigma by A_r(s) less that by boxes under every load, with a margin."""
    name = "estimates_agree"
    found = _mean(joint["ensemble"], "difference")
    # Of some realisations alone the mean would be that of those that touch most.
    known = joint["ensemble"]["difference_n"].values == joint["ensemble"].sizes["realisation"]
    if not known.any():
        return Finding(UNDETERMINED, "no load with both estimates of every realisation")
    each = [_equal(found[i], all_claims()[name].margin) for i in np.flatnonzero(known)]
    decided = [verdict for verdict in each if verdict != UNDETERMINED]
    value = found.value[known]
    ends = " to ".join(dict.fromkeys(f"{end:+.2f}" for end in (value[0], value[-1])))
    apart = loads_of(each.count(FAILS), len(each))
    return Finding(
        share_of(decided.count(HOLDS), len(decided)) if decided else UNDETERMINED,
        f"A_r(s) less boxes {ends}, no zero in the interval at {apart}",
        f"{_pressure(joint, known)}; {_margin_words(name)}",
    )


@of_the_area
@_of_realisations
def area_is_lacunar(joint: Joint) -> Finding:
    """Exponent of A_r over the resolutions, and whether it is one, at the reference load.

    It is one power law where Delta_sigma between the two finest resolutions is, within the margin,
    that between the two coarsest.
    """
    name, state = "area_is_lacunar", _reference(joint)
    delta, bend = delta_sigma_by_area(joint), _mean(state, "area_bend")
    if not np.isfinite(delta.width):
        return Finding(UNDETERMINED, "too few resolutions with thirty nodes in contact")
    falls = by_sign(delta.mapped(lambda value: 2 - value, falling=True), rising=True)
    one_power = _equal(bend, all_claims()[name].margin)
    verdict = falls if one_power == HOLDS or falls != HOLDS else PARTLY
    words = {HOLDS: "one power", FAILS: "not one power"}.get(one_power, "one power or not is open")
    return Finding(
        verdict,
        f"A_r ~ s^(2 - Delta_sigma), Delta_sigma = {delta:.2f}",
        f"{_pressure(joint)}; {words}: from the coarsest to the finest resolutions Delta_sigma "
        f"changes by {bend:+z.2f}; at light load the exponent is that of the slopes h'_rms(s) of "
        "the surface",
    )


@of_the_area
@_of_realisations
def dimension_rises_by_area(joint: Joint) -> Finding:
    """Slope of Delta_sigma from A_r(s) over the decades of F, with a margin."""
    return _trend(joint, "dimension_rises_by_area", "delta_sigma_area_trend")


@_of_realisations
def dimension_rises_by_boxes(joint: Joint) -> Finding:
    """Slope of Delta_sigma by boxes over the decades of F, beside that of as many random nodes.

    In part where it rises, but no faster than that of random nodes, which fill more boxes wherever
    they lie.
    """
    found = _trend(joint, "dimension_rises_by_boxes", "delta_sigma_trend")
    departure = _mean(joint["ensemble"], "departure_trend")
    only_more_nodes = found.verdict == HOLDS and not departure.low > 0
    return found._replace(
        verdict=PARTLY if only_more_nodes else found.verdict,
        numbers=f"{found.numbers}, less that of as many random nodes {departure:+z.2f}"
        if found.note
        else found.numbers,
    )


def _trend(joint: Joint, name: str, trend: str) -> Finding:
    """Verdict on a slope over the decades of F."""
    slope = _mean(joint["ensemble"], trend)
    if not slope.known:
        return Finding(UNDETERMINED, "fewer than two loads with a dimension of each")
    used = joint["ensemble"][f"{trend}_used"].values.astype(bool)
    return Finding(
        beyond_margin(slope, name, rising=True),
        f"{slope:+z.2f} a decade of F",
        f"{_pressure(joint, used)}; {_margin_words(name)}",
    )


@_of_realisations
def dimension_spans_all(joint: Joint) -> Finding:
    """Smallest and largest mean of Delta_sigma by boxes, near 0 and near 2 by their intervals."""
    stage = joint["ensemble"]
    delta = _mean(stage, "delta_sigma")
    every = stage["delta_sigma_n"].values == stage.sizes["realisation"]
    known = np.flatnonzero(every)
    if not known.size:
        return Finding(UNDETERMINED, "no load with a dimension by boxes of each")
    return span_finding(
        delta[known],
        stage["delta_sigma_random_mean"].values[known],
        stage["nominal_pressure"].values[known],
        f"loads of the ensemble at which all have a dimension{by_design(joint)}",
    )
