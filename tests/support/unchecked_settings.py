"""Settings that a study cannot state and the program works with: oblong windows, hostile labels."""

from copy import deepcopy
from dataclasses import replace

from fractalcontact.core.units import quantity
from fractalcontact.study.configuration import resolve_settings


def resolve_unchecked(study, name, own, source):
    """Settings of a specimen; a window may be two sides (y, x), a label any text."""
    study, own = deepcopy(study), dict(own)
    changes = {}
    for layer in (study.get("defaults", {}), study.get("specimens", {}).get(name, {}), own):
        if isinstance(layer.get("window"), list):
            sides = layer.pop("window")
            changes["window"] = [quantity(side, "length", "window") for side in sides]
        elif "window" in layer:
            changes.pop("window", None)
        if "label" in layer:
            changes["label"] = layer.pop("label")
    return replace(resolve_settings(study, name, own, source), **changes)
