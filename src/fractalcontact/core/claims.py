"""Statements of the paper, read from ``claims.yaml``: rules judge them, captions quote them."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import yaml

_FILE = Path(__file__).with_suffix(".yaml")


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, and the specimens for which it is judged.

    Attributes
    ----------
    name : str
        Name of the function that judges it.
    figure : str
        Figures or section of the paper.
    claim : str
        The statement in our words.
    margin : float
        Equivalence margin: an exponent, or a difference, whose interval stays below it is none.
    decides : str
        Measurement that would decide it where the data leave it open.
    short : str
        Its name in captions.
    material : str
        "rock" or "concrete" if the paper states it for one of them, else empty.
    slides : bool
        True if it is judged for joints that slide only.
    plastic : bool
        True if a hardness can change the answer: only these are judged for a specimen that stands
        in its study once more without one.
    joints : str
        "one", or "several" if it needs several joints.
    shown_in : str
        Figure that shows it; may be empty.
    check : bool
        True if no surface can refute it: it checks the solver, and counts among no verdicts.
    """

    name: str
    figure: str
    claim: str
    margin: float = 0.0
    decides: str = ""
    short: str = ""
    material: str = ""
    slides: bool = True
    plastic: bool = False
    joints: str = "one"
    shown_in: str = ""
    check: bool = False


@cache
def all_claims() -> dict[str, Claim]:
    """Every statement by name, in the order of the paper."""
    stated = yaml.safe_load(_FILE.read_text(encoding="utf-8"))
    return {name: Claim(name, **entry) for name, entry in stated.items()}


def claims_of(joints: str = "one") -> dict[str, Claim]:
    """Statements on one joint, or on several joints together."""
    return {name: claim for name, claim in all_claims().items() if claim.joints == joints}
