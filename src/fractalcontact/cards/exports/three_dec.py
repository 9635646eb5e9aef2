"""Constants for 3DEC: properties of the joint model ``mohr``, as commands of version 7 and 9."""

from collections.abc import Mapping
from typing import Any

from . import _itasca

ENDING = "dat"
NAMES = _itasca.Names(
    "3DEC", "stiffness-normal", "stiffness-shear", "friction", "dilation", "cohesion"
)


def text_of(card: Mapping[str, Any]) -> str:
    """Commands that assign the joint model and its properties."""
    return _itasca.text_of(
        card, NAMES, "block contact jmodel assign mohr", "block contact property"
    )
