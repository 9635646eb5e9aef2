"""Statements of the paper, compared with what was computed for a joint.

Every statement is judged by a number and a rule that stands in its function; the rules are ours,
for the paper gives none. All are judged in the first direction whose contact was solved, at the
scan's own resolution, and where one is needed at the load (and offset) of the contact maps.
"""

from collections.abc import Callable

import xarray as xr

from ..core.labels import cf_attrs
from . import mechanics, scaling
from .findings import FAILS, HOLDS, PARTLY, UNKNOWN, Finding, Joint

#: Figures of the paper, claim in our words, and what judges it.
Statement = tuple[str, str, Callable[[Joint], Finding]]

__all__ = ["FAILS", "HOLDS", "PARTLY", "UNKNOWN", "Finding", "Joint", "judge", "statements_for"]


def statements_for(slides: bool) -> tuple[Statement, ...]:
    """Figure, claim and judging function of every statement that can be asked.

    Parameters
    ----------
    slides : bool
        Whether the joint slides; sect. 5 asks nothing else of a surface against a plane.
    """
    return (mechanics.STATEMENTS if slides else ()) + scaling.STATEMENTS


def judge(stages: dict[str, xr.Dataset], settings: dict) -> xr.Dataset:
    """Judge every statement of :func:`statements_for` a joint.

    Parameters
    ----------
    stages : dict of str to xr.Dataset
        As :class:`Joint` has them.
    settings : dict
        From :func:`study.configuration.resolve_settings`.

    Returns
    -------
    xr.Dataset
        ``figure``, ``claim``, ``verdict`` and ``numbers`` over (statement,), all text; a statement
        is named after the function that judges it.
    """
    joint = Joint(stages, settings)
    asked = statements_for(joint.direction != "none")
    found = [check(joint) for _, _, check in asked]
    names = [check.__name__ for _, _, check in asked]
    columns = {
        "figure": ([figure for figure, _, _ in asked], "figures of the paper"),
        "claim": ([claim for _, claim, _ in asked], "what the paper says"),
        "verdict": ([finding.verdict for finding in found], "whether it holds for this joint"),
        "numbers": ([finding.numbers for finding in found], "the numbers that say so"),
    }
    result = xr.Dataset(
        {
            name: ("statement", text, cf_attrs("1", words))
            for name, (text, words) in columns.items()
        },
        coords={"statement": names},
    )
    return result.assign_attrs(direction=joint.direction, force=joint.force)
