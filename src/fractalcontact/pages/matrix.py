"""The paper's statements by specimens: each verdict with its rule, its numbers and its figure.

Verdicts are those of the stages ``statements`` and ``study_statements``; nothing is judged here.
"""

import inspect
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import xarray as xr

from ..core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED
from ..statements.judge import Statement, all_statements
from ..statements.study import STATEMENTS as OF_STUDY
from ..study.figure_list import FOLDER, all_figures

#: A sign for each verdict, and the class of its colour.
SIGNS = {
    HOLDS: ("●", "holds"),
    PARTLY: ("◐", "partly"),
    FAILS: ("○", "fails"),
    UNDETERMINED: ("?", "open"),
    ILL_POSED: ("×", "open"),
}


@dataclass(frozen=True)
class Cell:
    """A verdict on a statement, and where it comes from.

    Attributes
    ----------
    verdict, sign, kind : str
        In words; a sign; the class of its colour.
    numbers, note : str
        What decides it, and what to know of that.
    circular : str
        How the specimen was chosen for it; empty where it was not.
    figure : str
        Name of a figure that shows it; empty where there is none.
    """

    verdict: str
    sign: str
    kind: str
    numbers: str
    note: str
    circular: str
    figure: str


@dataclass(frozen=True)
class Row:
    """A statement, the rule that judges it, and its verdicts by specimen."""

    name: str
    figure: str
    claim: str
    rule: str
    cells: dict[str, Cell]


def matrix_of(atlas: xr.DataTree, specimens: Sequence[str]) -> list[Row]:
    """Statements that any of the specimens is asked, in the order of the paper.

    Parameters
    ----------
    atlas : xr.DataTree
        With the stage ``statements``.
    specimens : sequence of str
    """
    tables = {name: atlas[f"statements/{name}"].to_dataset() for name in specimens}
    return [row for one in all_statements() if (row := _row(one, tables)).cells]


def counted(rows: Iterable[Row]) -> dict[str, int]:
    """How often each verdict was given, in the order of :data:`SIGNS`; those never given not."""
    given = [cell.verdict for row in rows for cell in row.cells.values()]
    return {verdict: given.count(verdict) for verdict in SIGNS if verdict in given}


def of_study(atlas: xr.DataTree) -> list[Row]:
    """Statements that need several specimens: each has one cell, under the empty name."""
    if "study_statements" not in atlas.children:
        return []
    table = atlas["study_statements/study"].to_dataset()
    return [row for one in OF_STUDY if (row := _row(one, {"": table})).cells]


def _row(statement, tables):
    name = statement.check.__name__
    cells = {
        specimen: _cell(table.sel(statement=name), statement, sliding=_slides(table))
        for specimen, table in tables.items()
        if name in table["statement"].values
    }
    rule = inspect.getdoc(statement.check) or ""
    return Row(name, statement.figure, statement.claim, rule, cells)


def _slides(table):
    return table.attrs.get("direction", "") != "none"


def _cell(found, statement, *, sliding):
    verdict = str(found["verdict"].item())
    sign, kind = SIGNS[verdict]
    circular = str(found["circular_reason"].item()) if bool(found["circular"]) else ""
    subjects = ("specimen", "joint") if sliding else ("specimen",)
    return Cell(
        verdict=verdict,
        sign=sign,
        kind=kind,
        numbers=str(found["numbers"].item()),
        note=str(found["note"].item()),
        circular=circular,
        figure=figure_of_statement(statement, subjects),
    )


def figure_of_statement(statement: Statement, subjects: tuple[str, ...]) -> str:
    """Name of the figure that shows what a statement speaks of; the table of statements if none.

    It is one that quotes the verdict, best one of a number that the statement has; else one of that
    number.

    Parameters
    ----------
    statement : Statement
    subjects : tuple of str
        Of figures that may be chosen: those of a joint are not drawn of a surface against a plane.
    """
    quoting, numbered = [], []
    for name, figure in all_figures().items():
        if figure.subject not in subjects:
            continue
        common = bool(numbers_of(statement.figure) & _numbers_of_title(figure.title))
        if statement.check.__name__ in _names_in(figure.module):
            quoting.append((not common, name))
        elif common:
            numbered.append(name)
    if quoting:
        return min(quoting, key=lambda found: found[0])[1]
    return numbered[0] if numbered else "statements"


def numbers_of(figures: str) -> set[int]:
    """Numbers of the paper's figures in words: "4-7" or "1b, 11"; of sections none."""
    if "sect" in figures:
        return set()
    found: set[int] = set()
    for part in figures.split(","):
        ends = [int(number) for number in re.findall(r"\d+", part)]
        if ends:
            found |= set(range(ends[0], ends[-1] + 1))
    return found


def _numbers_of_title(title):
    """Numbers of the paper's figures that a title begins with: "Figs. 4 and 5: ..."."""
    start = re.match(r"Figs?\. ([\d, andb]+):", title)
    return {int(number) for number in re.findall(r"\d+", start[1])} if start else set()


@cache
def _names_in(module: str) -> frozenset[str]:
    """Words in quotation marks in a figure's module and in helpers beside it that it imports."""
    path = FOLDER.parent / f"{module}.py"
    text = path.read_text(encoding="utf-8")
    helpers = re.findall(r"^from \.(_\w+) import", text, re.MULTILINE)
    texts = [text, *((Path(path.parent) / f"{name}.py").read_text("utf-8") for name in helpers)]
    return frozenset(re.findall(r"[\"'](\w+)[\"']", "\n".join(texts)))
