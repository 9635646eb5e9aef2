"""Ensembles of a specimen beside the specimen itself."""

import numpy as np

from ...core.subject import Subject
from .panel import Panel

_ENDS = ("low", "high")


def members_of(subject: Subject) -> str:
    """Number and kind of the members of its ensemble, "20 twins of the scan"; empty without one."""
    if not subject.members:
        return ""
    return f"{subject['ensemble'].sizes['realisation']} {subject.members}"


def draw_band(panel: Panel, subject: Subject, name: str, colour: str, words: str) -> None:
    """Band over the loads in which 95 % of the members of its ensemble lie, and their mean.

    Nothing is drawn of a specimen without an ensemble, nor under loads at which some member has no
    value.

    Parameters
    ----------
    panel : Panel
        Of forces, N, along x.
    subject : Subject
    name : str
        Of the quantity in the stage ``ensemble``.
    colour : str
    words : str
        What the quantity is from, for the legend.
    """
    if not (members := members_of(subject)):
        return
    stage = subject["ensemble"]
    every = stage[f"{name}_n"] == stage.sizes["realisation"]
    shown = stage.isel(normal_force=np.flatnonzero(every))
    if not shown.sizes["normal_force"]:
        return
    force, low, high = (shown[of] for of in ("normal_force", *(f"{name}_band_{e}" for e in _ENDS)))
    label = f"band of {members}, {words}"
    panel.axes.fill_between(force, low, high, color=colour, alpha=0.2, lw=0, label=label)
    panel.axes.plot(
        force, shown[f"{name}_mean"], color=colour, lw=0.8, ls=":", label=f"their mean, {words}"
    )
    panel.keep(shown, f"{name}_mean", *(f"{name}_band_{end}" for end in _ENDS), f"{name}_n")
