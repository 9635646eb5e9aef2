"""Embedded specimens of a study that share one surface."""

from collections.abc import Mapping
from typing import Any

#: Key that asks for figures of one surface, elastic and capped; every study with one has it.
CAPPED_VARIANTS = "capped_variants"
#: Keys of a recipe that do not change its surface.
BESIDE_SURFACE = ("label", "chosen_for", "realisations")


def is_capped_variant(study: Mapping[str, Any], name: str | None) -> bool:
    """True if a study has the surface of an embedded specimen with a hardness again without one."""
    embedded = study.get("embedded", {})
    if name not in embedded or not _has_hardness(study, name):
        return False
    return any(
        _surface_of(embedded[other]) == _surface_of(embedded[name])
        and not _has_hardness(study, other)
        for other in embedded.keys() - {name}
    )


def _surface_of(recipe):
    """Keys of a recipe that make the surface."""
    return {key: value for key, value in recipe.items() if key not in BESIDE_SURFACE}


def _has_hardness(study, name):
    """True if the study caps the pressure of a specimen."""
    stated = {**study["defaults"], **study.get("specimens", {}).get(name, {})}["material"]
    # `configuration` refuses an unknown material.
    definition = stated if isinstance(stated, Mapping) else study["materials"].get(stated, {})
    return definition.get("hardness", "none") != "none"
