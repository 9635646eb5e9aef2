"""Change of k_ni and tangent stiffness at twice the spacing."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from ..core.subject import Subject
from .captions import symbols
from .words import percent


@dataclass(frozen=True)
class Doubled:
    """Changes when only every second node is kept, at the offset of the contact maps.

    Attributes
    ----------
    k_ni : float
        Of k_ni, as a fraction of it; NaN where twice the spacing was not solved, or nothing fits.
    stiffness : float
        Of the tangent stiffness under the reference load.
    """

    k_ni: float
    stiffness: float


def doubled_spacing(subject: Subject) -> Doubled:
    """Changes of both stiffnesses of a specimen at twice the spacing."""
    state = subject.state("closure")
    return Doubled(*(float(state[f"{of}_change"]) for of in ("seated_k_ni", "interface_stiffness")))


def spacing_words(found: Sequence[Doubled]) -> Markup:
    """Sentence on the change of k_ni and tangent stiffness with the spacing; empty if unknown.

    Parameters
    ----------
    found : sequence of Doubled
        Of all specimens.
    """
    initial = [one.k_ni for one in found if math.isfinite(one.k_ni)]
    if not initial:
        return Markup("")
    text = f"If only every second point of a scan is used, k_ni changes by {_range(initial)}"
    tangent = [one.stiffness for one in found if math.isfinite(one.stiffness)]
    if tangent:
        text += f" and the tangent stiffness under the reference load by {_range(tangent)}"
    return symbols(f"{text}.")


def _range(changes):
    """Least to largest change, with their signs."""
    ends = min(changes), max(changes)
    return " to ".join(dict.fromkeys(f"{'+' if end > 0 else ''}{percent(end)}" for end in ends))
