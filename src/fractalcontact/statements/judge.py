"""Statements of the paper, compared with what was computed for a joint.

Every statement is judged by one function, with a number and a rule that stands in it; the rules are
ours, for the paper gives none. Captions and tables quote what it finds. All are judged in the first
direction whose contact was solved, at the scan's own resolution, and where one is needed at the
load (and offset) of the contact maps.
"""

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..core.claims import Claim, all_claims, claims_of
from ..core.directions import slides
from ..core.labels import cf_attrs
from ..core.verdicts import ILL_POSED, UNDETERMINED
from . import closure, nulls, scaling, sizes, sliding
from .findings import Finding, Joint

#: Material of the paper by words in the name of a study's material.
MATERIALS = {"sandstone": "rock", "rock": "rock", "concrete": "concrete"}


def rule_of(name: str) -> Callable[..., Finding]:
    """Function that judges a statement about one joint: the one of its name."""
    for room in (closure, sliding, scaling, sizes, nulls):
        if hasattr(room, name):
            return getattr(room, name)
    raise KeyError(f"no rule is called {name!r}")


def material_of(settings: Mapping) -> str:
    """Material of a specimen in the paper's terms, "rock" or "concrete"; empty if neither."""
    words = str(settings["material"]["name"]).replace("_", " ").split()
    return next((MATERIALS[word] for word in words if word in MATERIALS), "")


def statements_for(settings: Mapping) -> tuple[str, ...]:
    """Names of the statements that are asked of a specimen, from its settings.

    A statement on one of the paper's materials is asked of that one. A joint that stands in its
    study once more without a hardness (``capped_variant``) is not asked what a hardness cannot
    change.
    """
    material = material_of(settings)
    sliding = slides(settings["opposite"])
    return tuple(
        name
        for name, claim in claims_of("one").items()
        if claim.material in ("", material)
        and (sliding or not claim.slides)
        and (claim.plastic or not settings["capped_variant"])
    )


def judge(stages: Mapping[str, xr.Dataset], settings: Mapping) -> xr.Dataset:
    """Judgement of every statement that a joint is asked (:func:`statements_for`), as
    :func:`table_of` has it.

    ``chosen_for`` of the settings names statements that the specimen was chosen for, and how.
    The verdicts of a specimen of ``known_contact`` are not counted.
    Attributes ``direction`` and ``force``, N.
    """
    joint = Joint(dict(stages), dict(settings))
    rules = {name: rule_of(name) for name in statements_for(settings)}
    table = table_of(rules, joint, settings["chosen_for"], counted=not settings["known_contact"])
    return table.assign_attrs(direction=joint.direction, force=joint.force)


def table_of(
    rules: Mapping[str, Callable[..., Finding]],
    subject: Any,
    circular: Mapping[str, str],
    asked: str = "this specimen",
    *,
    counted: bool = True,
) -> xr.Dataset:
    """Statements judged, over (statement,).

    Parameters
    ----------
    rules : mapping of str to callable
        Functions from the subject to a finding, by the statement's name.
    subject : findings.Joint, or several by their names
    circular : mapping of str to str
        How the specimen was chosen for a statement, by the statement's name.
    asked : str, optional
        The subject in words.
    counted : bool, optional
        False of a subject whose contact is known by construction: its verdicts check the rules, and
        say nothing of joints.
    """
    findings = [rule(subject) for rule in rules.values()]
    claims = [all_claims()[name] for name in rules]
    columns = {
        "figure": ([claim.figure for claim in claims], "figures of the paper"),
        "claim": ([claim.claim for claim in claims], "statement of the paper"),
        "short": ([claim.short for claim in claims], "how captions call it"),
        "rule": ([inspect.getdoc(rule) or "" for rule in rules.values()], "the rule that judges"),
        "verdict": ([finding.verdict for finding in findings], "whether it holds here"),
        "numbers": ([finding.numbers for finding in findings], "the numbers that decide it"),
        "note": (
            [_note(finding, claim) for finding, claim in zip(findings, claims, strict=True)],
            "remark on these numbers, and what would decide the statement if they do not",
        ),
        "explanation": (
            [finding.explanation for finding in findings],
            "what a null model does in the same data",
        ),
        "judged_on": ([finding.judged_on or asked for finding in findings], "evidence judged"),
        "circular": (
            np.array([name in circular for name in rules], bool),
            "whether the specimen was chosen for it",
        ),
        "counted": (
            counted & ~np.array([claim.check for claim in claims], bool) & ~_repeated(findings),
            "whether it counts among the verdicts: no check, and no repeated ill-posed question",
        ),
        "circular_reason": (
            [circular.get(name, "") for name in rules],
            "how the specimen was chosen for it",
        ),
    }
    return xr.Dataset(
        {
            name: ("statement", values, cf_attrs("1", words))
            for name, (values, words) in columns.items()
        },
        coords={"statement": list(rules)},
    )


def _repeated(findings: Sequence[Finding]) -> np.ndarray:
    """Findings (n,) bool that call a question ill-posed for the reason of an earlier one."""
    reasons = [one.numbers if one.verdict == ILL_POSED else "" for one in findings]
    return np.array([bool(of) and of in reasons[:i] for i, of in enumerate(reasons)], bool)


def _note(finding: Finding, claim: Claim) -> str:
    """Note on a finding, ending with what would decide it where it is undetermined."""
    remedy = claim.decides if finding.verdict == UNDETERMINED else ""
    return "; ".join(filter(None, (finding.note, remedy)))
