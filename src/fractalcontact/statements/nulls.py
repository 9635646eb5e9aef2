"""What is judged beside a rival: closure laws, null models of the contact domain, its isotropy."""

import numpy as np

from ..domain import departure
from ..domain.departure import LIKE_CUT, LIKE_RANDOM, is_fractal
from ..mechanics.closure_laws import HYPERBOLA, UNDECIDED
from .findings import (
    FAILS,
    HOLDS,
    LOOSELY,
    NEARLY,
    PARTLY,
    UNDETERMINED,
    Finding,
    Joint,
    Statement,
    share,
)

_OF_SLIDING = ("along sliding", "across")

#: What is compared with the bearing-area cut.
_BESIDE_CUT = ("delta_sigma", "correlation_dimension")

#: What a departure that is not fractal leaves of "lacunar fractal sets".
_LEFT = {LIKE_RANDOM: FAILS, LIKE_CUT: PARTLY}


def closure_is_hyperbolic(joint: Joint) -> Finding:
    """The closure law that fits better, hyperbola or semi-logarithmic, at every offset."""
    curves = joint.stages["closure"].sel(direction=joint.direction)
    curves = curves.sel(resolution=curves["resolution"].min())
    slid = joint.offset > 0
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
    """Box-counting dimension beside as many random nodes and the bearing-area cut."""
    state = joint.map_state("domains")
    verdict = str(state["null_verdict"].item())
    value, cut = (float(state[f"delta_sigma{end}"]) for end in ("", "_cut"))
    if not np.isfinite(value):
        return Finding(UNDETERMINED, f"no dimension: {state['reason'].item()}")
    if verdict == departure.UNDETERMINED:
        low, high = (float(state[f"delta_sigma_{end}"]) for end in ("low", "high"))
        return Finding(UNDETERMINED, f"interval of Delta_sigma {high - low:.1f} wide")
    less, low, high = (
        float(state[f"delta_sigma_random_difference{end}"]) for end in ("", "_low", "_high")
    )
    pairs = float(state["correlation_dimension_random_difference"])
    found = HOLDS if is_fractal(verdict) else _LEFT[verdict]
    if found == FAILS and max(-low, high) > LOOSELY:
        # Not distinguished by a difference that is not known well enough.
        found = UNDETERMINED
    return Finding(
        found,
        f"{verdict}, Delta_sigma less that of random {less:+.2f} [{low:+.2f}, {high:+.2f}]",
        f"Delta_sigma = {value:.2f}, less that of as many random nodes {less:+.2f} [{low:+.2f}, "
        f"{high:+.2f}], of the cut {cut:.2f}; correlation dimension less that of random nodes "
        f"{pairs:+.2f}: contact is clustered, which alone is no fractal",
    )


def domains_differ_from_cuts(joint: Joint) -> Finding:
    """Elastic contact domain against the cut of the composite topography, over the loads.

    Not coincident where box-counting and correlation dimension both differ by more than their
    intervals; not related where the interval of the difference of either lies beyond a quarter.
    """
    states = joint.map_states("domains")
    less = {
        end: np.array([states[f"{name}_cut_difference{end}"].values for name in _BESIDE_CUT])
        for end in ("", "_low", "_high")
    }
    known = np.isfinite([*less.values()]).all(axis=(0, 1))
    if not known.any():
        return Finding(UNDETERMINED, "no load at which domain and cut have their dimensions")
    value, low, high = (less[end][:, known] for end in ("", "_low", "_high"))
    apart = sum(map(departure.leave_zero_out, np.stack([low, high], axis=-1).swapaxes(0, 1)))
    unrelated = bool(((low > LOOSELY) | (high < -LOOSELY)).any())
    ends = " to ".join(dict.fromkeys(f"{d:+.2f}" for d in (value[0].min(), value[0].max())))
    total = value.shape[1]
    verdict = FAILS if unrelated else share(apart, total) if apart else UNDETERMINED
    return Finding(
        verdict,
        f"domain less cut {ends}",
        f"apart beyond the interval, by boxes and by pairs, at {apart} of {total} loads",
    )


def domains_are_isotropic(joint: Joint) -> Finding:
    """Contact at a lag from a node in contact, along the sliding and across it.

    What scales alike along both axes has the same probability along both.
    """
    measures = joint.stages["domain_measures"].sel(normal_force=joint.force, method="nearest")
    (along, low, high), (across, *other) = (
        [float(measures[f"contact_at_lag_{way}{end}"]) for end in ("", "_low", "_high")]
        for way in ("along", "across")
    )
    if not np.isfinite([along, across]).all() or along + across == 0:
        return Finding(UNDETERMINED, "no contact at that lag from another")
    ways = ("along x", "along y") if joint.settings["opposite"] == "flat" else _OF_SLIDING
    numbers = (
        f"contact at a lag {along:.2f} [{low:.2f}, {high:.2f}] {ways[0]}, {across:.2f} "
        f"[{other[0]:.2f}, {other[1]:.2f}] {ways[1]}"
    )
    apart = max(low, other[0]) > min(high, other[1])
    difference = abs(across - along) / (across + along)
    if apart:
        return Finding(FAILS if difference > LOOSELY else PARTLY, numbers)
    return Finding(HOLDS if difference <= NEARLY else UNDETERMINED, numbers)


#: All of them.
STATEMENTS = (
    Statement("4, 5", "The closure curves are hyperbolas with an asymptote", closure_is_hyperbolic),
    Statement(
        "sect. 6",
        "Contact domains are lacunar fractal sets",
        domains_are_fractal,
        slides=False,
        plastic=True,
    ),
    Statement(
        "sect. 6",
        "Contact domains are related, but not coincident, to cuts at one height",
        domains_differ_from_cuts,
        slides=False,
    ),
    Statement(
        "sect. 6", "Contact domains scale isotropically", domains_are_isotropic, slides=False
    ),
)
