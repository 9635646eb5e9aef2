"""Ensembles of a specimen beside the specimen itself."""

import numpy as np

from ...core.subject import Subject
from .panel import Panel

_ENDS = ("low", "high")


def members_of(subject: Subject) -> str:
    """Number and kind of the members of an ensemble, "20 twins of the scan"; empty without one."""
    if not subject.members:
        return ""
    return f"{subject['ensemble'].sizes['realisation']} {subject.members}"


def draw_band(
    panel: Panel,
    subject: Subject,
    name: str,
    colour: str,
    words: str,
    x: str = "normal_force",
    **at: float,
) -> None:
    """Band in which 95 % of the members of the ensemble lie, and their mean.

    Nothing is drawn of a specimen without an ensemble, nor where some member has no value: the band
    would be that of the others alone.

    Parameters
    ----------
    panel : Panel
    subject : Subject
    name : str
        Quantity of the stage ``ensemble``.
    colour : str
    words : str
        Estimator or panel, for the legend.
    x : str, optional
        Variable along x.
    **at
        Selection along further dimensions of the quantity.
    """
    if not (members := members_of(subject)):
        return
    stage = subject["ensemble"].sel(at, method="nearest")
    every = stage[f"{name}_n"] == stage.sizes["realisation"]
    shown = stage.isel({every.dims[0]: np.flatnonzero(every)})
    if not shown.sizes[every.dims[0]]:
        return
    force, low, high = (shown[of] for of in (x, *(f"{name}_band_{end}" for end in _ENDS)))
    label = f"band of {members}, {words}"
    panel.axes.fill_between(force, low, high, color=colour, alpha=0.2, lw=0, label=label, zorder=0)
    panel.axes.plot(
        force, shown[f"{name}_mean"], color=colour, lw=0.8, ls=":", label=f"their mean, {words}"
    )
    panel.keep(shown, f"{name}_mean", *(f"{name}_band_{end}" for end in _ENDS), f"{name}_n")
