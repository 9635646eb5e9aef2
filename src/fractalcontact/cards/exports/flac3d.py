"""Constants for FLAC3D: properties of the nodes of an interface, as commands of version 7 and 9."""

from collections.abc import Mapping
from typing import Any

from . import _itasca

ENDING = "dat"
NAMES = _itasca.Names(
    "FLAC3D", "stiffness-normal", "stiffness-shear", "friction", "dilation", "cohesion"
)


def text_of(card: Mapping[str, Any]) -> str:
    """Commands that assign the properties of an interface that there is."""
    return _itasca.text_of(card, NAMES, "", "zone interface node property")
