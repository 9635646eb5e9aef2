"""Campaigns, studies of many specimens: form of the atlas, and figures of each specimen."""

from collections.abc import Collection, Mapping
from typing import Any

from .figure_list import all_figures, figures_of

#: Most specimens of an atlas in one file, unless the study says otherwise. Writing one file of many
#: specimens takes memory for all of them, and opening it takes time for all of them.
MAX_WHOLE = 30
#: Forms of an atlas: one file, or one file a specimen.
WHOLE, PARTS = "whole", "parts"
#: Words of a study for all figures, for those of the owner of a joint, and for none.
ALL, JOINT, NONE = "all", "joint", "none"
#: Key that asks for the figures over several specimens; every study of more than one has it.
COMPARISON = "comparison"


def in_parts(config: Mapping[str, Any], specimens: Collection[str]) -> bool:
    """True if the atlas of a checked study has one file a specimen and one more for all of them."""
    unsaid = WHOLE if len(specimens) <= MAX_WHOLE else PARTS
    return bool(config.get("atlas", unsaid) == PARTS)


def drawn_of(config: Mapping[str, Any], specimens: Collection[str], opposite: str) -> list[str]:
    """Names of the figures drawn of each specimen with an opposite face.

    Where the atlas is in parts, none is drawn unless the study asks for it.
    """
    stated = config.get("figures", NONE if in_parts(config, specimens) else ALL)
    names = figures_of(opposite)
    if stated == ALL:
        return names
    if stated == JOINT:
        return [name for name in names if all_figures()[name].joint_study]
    return [] if stated == NONE else [name for name in names if name in stated]


def explored(config: Mapping[str, Any], specimens: Collection[str]) -> list[str]:
    """Specimens of a study whose states the explorer shows: all, or of many those named."""
    asked = config.get("explorer", [] if in_parts(config, specimens) else specimens)
    return [name for name in asked if name in specimens]


def of_study_alone(names: Collection[str]) -> list[str]:
    """Figures of a study that read no stage of its specimens one by one.

    An atlas in parts lacks the stages of single specimens.
    """
    return [name for name in names if "specimens" not in all_figures()[name].needs]
