"""What is judged beside a rival: closure laws, null models of the contact domain, its isotropy."""

import numpy as np
import xarray as xr

from ..core.intervals import mean_interval
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

#: Of the stage ``closure``: the closure law that fits better.
HYPERBOLA, LOGARITHM = "hyperbola", "semi-logarithmic"

#: Of the stage ``domains``: what its two null models leave of a dimension.
BEYOND, LIKE_RANDOM, LIKE_CUT = (
    "beyond both nulls",
    "not distinguishable from random",
    "not distinguishable from the bearing-area cut",
)

#: Pairs of nodes that a comparison of two directions needs, as an expected number of contacts.
FEWEST_CONTACTS = 10


def closure_is_hyperbolic(joint: Joint) -> Finding:
    """The closure law that fits better, hyperbola or semi-logarithmic, at every offset."""
    curves = joint.stages["closure"].sel(direction=joint.direction)
    curves = curves.sel(resolution=curves["resolution"].min())
    slid = joint.offset > 0
    laws = curves["closure_law"].values.astype(str)[slid]
    decided = np.isin(laws, (HYPERBOLA, LOGARITHM))
    if not decided.any():
        return Finding(UNDETERMINED, f"neither law fits better at any of {slid.sum()} offsets")
    misfits = " against ".join(
        f"{100 * np.nanmedian(curves[name].values[slid][decided]):.2g} %"
        for name in ("hyperbola_misfit", "semilog_misfit")
    )
    better = int((laws[decided] == HYPERBOLA).sum())
    return Finding(
        share(better, int(decided.sum())),
        f"the better law at {better} of {decided.sum()} offsets",
        f"than w = a + b ln sigma_0; median misfit {misfits}",
    )


def domains_are_fractal(joint: Joint) -> Finding:
    """Box-counting dimension beside as many random nodes and the bearing-area cut."""
    state = joint.map_state("domains")
    verdict = str(state["null_verdict"].item())
    value, random, low, high, cut = (
        float(state[f"delta_sigma{end}"])
        for end in ("", "_random", "_random_low", "_random_high", "_cut")
    )
    if not np.isfinite(value):
        return Finding(UNDETERMINED, f"no dimension: {state['reason'].item()}")
    return Finding(
        {BEYOND: HOLDS, LIKE_RANDOM: FAILS, LIKE_CUT: PARTLY}.get(verdict, UNDETERMINED),
        verdict,
        f"Delta_sigma = {value:.2f}, random nodes {random:.2f} [{low:.2f}, {high:.2f}], cut "
        f"{cut:.2f}",
    )


def domains_differ_from_cuts(joint: Joint) -> Finding:
    """Elastic contact domain against the cut of the composite topography, over the loads.

    Related where their dimensions never differ by more than a quarter; not coincident where the
    mean of the differences, each of two sets of as many nodes, is not zero.
    """
    states = joint.map_states("domains")
    difference = (states["delta_sigma"] - states["delta_sigma_cut"]).values
    difference = difference[np.isfinite(difference)]
    mean, low, high = map(float, mean_interval(difference)[:3])
    if not np.isfinite(low):
        return Finding(UNDETERMINED, f"{difference.size} loads with both dimensions, two needed")
    apart = low > 0 or high < 0
    related = np.abs(difference).max() <= LOOSELY
    return Finding(
        FAILS if not related else HOLDS if apart else UNDETERMINED,
        f"domain less cut {mean:+.2f} [{low:+.2f}, {high:+.2f}] on average, at most "
        f"{np.abs(difference).max():.2f}, {difference.size} loads",
    )


def domains_are_isotropic(joint: Joint) -> Finding:
    """Contact at a lag from a node in contact, along the sliding and across it."""
    measures = joint.stages["domain_measures"].sel(normal_force=joint.force, method="nearest")
    along, across = (
        np.atleast_1d(_flat(measures[f"contact_at_lag_{way}"])) for way in ("along", "across")
    )
    known = np.isfinite(along) & np.isfinite(across) & (along + across > 0)
    if not known.any():
        return Finding(UNDETERMINED, "no contact at any lag from another")
    along, across = along[known], across[known]
    difference = (across - along) / (across + along)
    largest = int(np.argmax(np.abs(difference)))
    nodes = float(joint.at_load("closure", "nodes")[_nearest(joint.offset, joint.map_offset)])
    numbers = (
        f"contact at a lag {along[largest]:.2f} along, {across[largest]:.2f} across the sliding"
    )
    if not nodes * (along[largest] + across[largest]) >= FEWEST_CONTACTS:
        return Finding(UNDETERMINED, numbers)
    spread = float(np.abs(difference).max())
    verdict = HOLDS if spread <= NEARLY else PARTLY if spread <= LOOSELY else FAILS
    return Finding(verdict, numbers)


def _flat(values: xr.DataArray) -> np.ndarray:
    return values.values.ravel()


def _nearest(values: np.ndarray, wanted: float) -> int:
    return int(np.argmin(np.abs(values - wanted)))


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
