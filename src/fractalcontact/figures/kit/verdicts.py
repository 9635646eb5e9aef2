"""Verdicts on the paper's statements, as captions quote them from :mod:`statements`."""

import contextlib
from collections.abc import Iterator, Sequence

import xarray as xr
from xarray import DataTree

from ...core.claims import all_claims
from ...core.labels import printable
from ...core.subject import Subject
from ...core.verdicts import ILL_POSED, UNDETERMINED

#: Words added to a verdict where the specimen was chosen for it: in a sentence, in a table.
CIRCULAR, CIRCULAR_SHORT = "circular: the specimen was chosen to show it", "circular"
#: Sets that names of the statements read are added to.
_QUOTED: list[set[str]] = []


@contextlib.contextmanager
def statements_quoted() -> Iterator[set[str]]:
    """Set of the names of statements that :func:`row_of` reads within the block."""
    quoted: set[str] = set()
    _QUOTED.append(quoted)
    try:
        yield quoted
    finally:
        _QUOTED.pop()


def verdict_words(
    atlas: DataTree, name: str, statement: str, *, numbers: bool = True, why: str = ""
) -> str:
    """Verdict on a statement with the numbers that decide it, as the table of statements has them.

    "holds (A_r ~ F^m, m = 0.95 to 1.02)"; empty where the statement does not apply.

    Parameters
    ----------
    atlas : DataTree
        With the stage ``statements``.
    name : str
        The specimen.
    statement : str
        Name of the function that judges it.
    numbers : bool, optional
        Whether the numbers follow.
    why : str, optional
        Reason that the eye cannot see, after the numbers; an ill-posed question states its own.
    """
    row = row_of(atlas, "statements", name, statement)
    if row is None:
        return ""
    words = str(row["verdict"].item())
    if why and words == ILL_POSED:
        numbers, why = True, ""
    said = [str(row["numbers"].item())] if numbers else []
    if why:
        said.append(why)
    if bool(row["circular"]):
        said.append(CIRCULAR)
    return f"{words} ({'; '.join(said)})" if said else words


def claim(
    atlas: DataTree,
    name: str,
    statement: str,
    *,
    numbers: bool = True,
    why: str = "",
) -> str:
    """Sentence with a statement of the paper and its verdict; empty where it does not apply.

    Parameters are those of :func:`verdict_words`.
    """
    words = predicate(verdict_words(atlas, name, statement, numbers=numbers, why=why))
    return f"The paper's claim that {all_claims()[statement].short} {words}." if words else ""


def predicate(verdict: str) -> str:
    """Verdict as the end of a sentence: "holds", "is undetermined"."""
    return f"is {verdict}" if verdict.startswith((ILL_POSED, UNDETERMINED)) else verdict


def labels_by_verdict(
    atlas: DataTree, names: Sequence[str], statements: Sequence[str], letters: int
) -> dict[str, list[str]]:
    """Labels, of up to `letters` letters, of specimens that statements apply to, by verdict."""
    labels: dict[str, list[str]] = {}
    for name in names:
        for row in (row_of(atlas, "statements", name, statement) for statement in statements):
            if row is not None:
                circular = f" ({CIRCULAR_SHORT})" if row["circular"] else ""
                label = printable(Subject.of(atlas, name).label, letters)
                labels.setdefault(row["verdict"].item(), []).append(f"{label}{circular}")
    return labels


def row_of(atlas: DataTree, stage: str, name: str, statement: str) -> xr.Dataset | None:
    """One statement of a table of statements; None where it does not apply.

    Raises
    ------
    KeyError
        If there is no such statement, or the specimen has no table: no verdict is left out in
        silence.
    """
    if statement not in all_claims():
        raise KeyError(f"no statement is called {statement!r}")
    for quoted in _QUOTED:
        quoted.add(statement)
    table = atlas[f"{stage}/{name}"].to_dataset()
    asked = statement in table["statement"].values
    return table.sel(statement=statement) if asked else None
