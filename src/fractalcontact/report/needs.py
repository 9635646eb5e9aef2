"""Reasons why a specimen has no value of a quantity: what it or its study lacks."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from ..core.labels import OPPOSITE
from ..core.subject import Subject


def _unstated(key: str, words: str) -> Callable[[Subject], str]:
    """Reason for a quantity that needs a number of the material; empty where it is stated."""

    def reason(subject: Subject) -> str:
        stated = subject.settings["material"].get(key)
        is_stated = stated is not None and math.isfinite(stated)
        return "" if is_stated else f"no {words} is stated"

    return reason


def _not_sliding(subject: Subject) -> str:
    """Reason for a quantity that needs faces that slide."""
    if "strength" in subject.stages:
        return ""
    return f"nothing slides: {OPPOSITE[subject['specimens'].attrs['opposite']]}"


def _too_few_offsets(subject: Subject) -> str:
    """Reason for a quantity that needs offsets in the reported direction."""
    if subject.direction == "none":
        return "does not slide"
    return "" if subject.direction in subject["joints"]["direction"] else "too few offsets"


def _no_jrc(subject: Subject) -> str:
    is_known = np.isfinite(subject.states("strength")["jrc_used"].item())
    return "" if is_known else "no JRC at the step of its law"


#: Functions that say why a specimen lacks what a quantity needs; "" where it has it.
NEEDS: Mapping[str, Callable[[Subject], str]] = {
    "sliding": _not_sliding,
    "offsets": _too_few_offsets,
    "basic_friction_angle": _unstated("basic_friction_angle", "basic friction angle"),
    "joint_wall_strength": _unstated("joint_wall_strength", "joint wall strength"),
    "jrc": _no_jrc,
}
