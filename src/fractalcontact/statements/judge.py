"""Statements of the paper, compared with what was computed for a joint.

Every statement is judged by one function, with a number and a rule that stands in it; the rules are
ours, for the paper gives none. Captions and tables quote what it finds. All are judged in the first
direction whose contact was solved, at the scan's own resolution, and where one is needed at the
load (and offset) of the contact maps.
"""

from collections.abc import Iterable, Mapping

import numpy as np
import xarray as xr

from ..core.labels import cf_attrs
from . import closure, nulls, scaling, sliding
from .findings import Finding, Joint, Statement

#: Which of its two materials the paper would take a study's for, by words in its name.
MATERIALS = {"sandstone": "rock", "rock": "rock", "concrete": "concrete"}


def all_statements() -> tuple[Statement, ...]:
    """Every statement that a joint can be asked, in the order of the paper."""
    return closure.STATEMENTS + sliding.STATEMENTS + scaling.STATEMENTS + nulls.STATEMENTS


def material_of(settings: Mapping) -> str:
    """The paper's material that a specimen is of, "rock" or "concrete"; empty if neither."""
    words = str(settings["material"]["name"]).replace("_", " ").split()
    return next((MATERIALS[word] for word in words if word in MATERIALS), "")


def statements_for(settings: Mapping, *, capped_variant: bool = False) -> tuple[Statement, ...]:
    """Statements that are asked of a specimen.

    Parameters
    ----------
    settings : mapping
        From :func:`study.configuration.resolve_settings`: its ``opposite`` and ``material``. What
        the paper says of one of its materials is asked of that one.
    capped_variant : bool, optional
        Whether the specimen stands in its study once more without a hardness: what a hardness
        cannot change is then answered there.
    """
    material = material_of(settings)
    slides = settings["opposite"] != "flat"
    return tuple(
        statement
        for statement in all_statements()
        if statement.material in ("", material)
        and (slides or not statement.slides)
        and (statement.plastic or not capped_variant)
    )


def judge(
    stages: Mapping[str, xr.Dataset],
    settings: Mapping,
    *,
    circular: Mapping[str, str] | None = None,
    capped_variant: bool = False,
) -> xr.Dataset:
    """Judge every statement of :func:`statements_for` a joint.

    Parameters
    ----------
    stages : mapping of str to xr.Dataset
        As :class:`findings.Joint` has them.
    settings : mapping
        From :func:`study.configuration.resolve_settings`.
    circular : mapping of str to str, optional
        Statements that the specimen was chosen for, and how.
    capped_variant : bool, optional
        As for :func:`statements_for`.

    Returns
    -------
    xr.Dataset
        As :func:`table_of` makes it; attributes ``direction`` and ``force``, N.
    """
    joint = Joint(dict(stages), dict(settings))
    asked = statements_for(settings, capped_variant=capped_variant)
    found = [(statement, statement.check(joint)) for statement in asked]
    return table_of(found, circular or {}).assign_attrs(
        direction=joint.direction, force=joint.force
    )


def table_of(found: Iterable[tuple[Statement, Finding]], circular: Mapping[str, str]) -> xr.Dataset:
    """Findings as a dataset.

    Parameters
    ----------
    found : iterable of (Statement, Finding)
    circular : mapping of str to str
        How the specimen was chosen for a statement, by the statement's name.

    Returns
    -------
    xr.Dataset
        ``figure``, ``claim``, ``verdict``, ``numbers``, ``note``, ``circular`` and
        ``circular_reason`` over (statement,); a statement is named after the function that judges
        it.
    """
    found = list(found)
    names = [statement.check.__name__ for statement, _ in found]
    columns = {
        "figure": ([statement.figure for statement, _ in found], "figures of the paper"),
        "claim": ([statement.claim for statement, _ in found], "what the paper says"),
        "verdict": ([finding.verdict for _, finding in found], "whether it holds here"),
        "numbers": ([finding.numbers for _, finding in found], "the numbers that decide it"),
        "note": ([finding.note for _, finding in found], "what to know of these numbers"),
        "circular": (
            np.array([name in circular for name in names], bool),
            "whether the specimen was chosen for it",
        ),
        "circular_reason": (
            [circular.get(name, "") for name in names],
            "how the specimen was chosen for it",
        ),
    }
    return xr.Dataset(
        {
            name: ("statement", values, cf_attrs("1", words))
            for name, (values, words) in columns.items()
        },
        coords={"statement": names},
    )
