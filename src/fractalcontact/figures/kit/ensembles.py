"""Ensembles of a specimen beside the specimen itself."""

import numpy as np

from ...core.subject import Subject
from .panel import Panel

_ENDS = ("low", "high")


def realisations_of(subject: Subject) -> int:
    """Realisations of the ensemble of a specimen; 0 without one."""
    return subject["ensemble"].sizes["realisation"] if "ensemble" in subject.stages else 0


def draw_band(panel: Panel, subject: Subject, name: str, colour: str, words: str) -> None:
    """Band over the loads in which 95 % of the realisations of a specimen lie, and their mean.

    Nothing is drawn of a specimen without an ensemble, nor under loads at which some realisation
    has no value.

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
    if not (realisations := realisations_of(subject)):
        return
    stage = subject["ensemble"]
    shown = stage.isel(normal_force=np.flatnonzero(stage[f"{name}_n"] == realisations))
    if not shown.sizes["normal_force"]:
        return
    force, low, high = (shown[of] for of in ("normal_force", *(f"{name}_band_{e}" for e in _ENDS)))
    label = f"band of {realisations} realisations, {words}"
    panel.axes.fill_between(force, low, high, color=colour, alpha=0.2, lw=0, label=label)
    panel.axes.plot(
        force, shown[f"{name}_mean"], color=colour, lw=0.8, ls=":", label=f"their mean, {words}"
    )
    panel.keep(shown, f"{name}_mean", *(f"{name}_band_{end}" for end in _ENDS), f"{name}_n")
