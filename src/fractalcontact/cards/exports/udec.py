"""Constants for UDEC: properties of a joint material by their classical names.

The line is that of versions up to 6. Version 7 has the names of 3DEC (`three_dec`), and tables by
name: here they are comments.
"""

from collections.abc import Mapping
from typing import Any

from . import _itasca

ENDING = "dat"
NAMES = _itasca.Names("UDEC", "jkn", "jks", "jfric", "jdil", "jcoh", "; table")


def text_of(card: Mapping[str, Any]) -> str:
    """A line of properties of joint material 1."""
    return _itasca.text_of(card, NAMES, "", "prop jmat=1")
