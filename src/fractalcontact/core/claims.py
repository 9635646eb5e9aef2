"""Statements of the paper, read from ``claims.yaml``: rules judge them, captions quote them."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import yaml

_FILE = Path(__file__).with_suffix(".yaml")


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, and of which specimens it is asked.

    Attributes
    ----------
    name : str
        Of the function that judges it.
    figure : str
        Figures or section of the paper.
    claim : str
        In our words.
    margin : float
        Equivalence margin: an exponent, or a difference, whose interval stays below it is none.
    decides : str
        What would decide it where the data leave it open.
    short : str
        How captions call it.
    material : str
        "rock" or "concrete" where the paper says it of one of them, else empty.
    slides : bool
        Whether only a joint that slides is asked.
    plastic : bool
        Whether a hardness can change the answer: these alone are asked of a specimen that stands
        in its study once more without one.
    joints : str
        "one", or "several" where it needs them.
    shown_in : str
        Figure that shows it; empty where none does.
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


@cache
def all_claims() -> dict[str, Claim]:
    """Every statement by name, in the order of the paper."""
    stated = yaml.safe_load(_FILE.read_text(encoding="utf-8"))
    return {name: Claim(name, **entry) for name, entry in stated.items()}


def claims_of(joints: str = "one") -> dict[str, Claim]:
    """Statements on one joint, or on several joints together."""
    return {name: claim for name, claim in all_claims().items() if claim.joints == joints}
