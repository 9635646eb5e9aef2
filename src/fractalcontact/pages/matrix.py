"""The paper's statements by specimens: each verdict with its rule, its numbers and its figure.

Verdicts are those of the stages ``statements`` and ``study_statements``; nothing is judged here.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import pandas as pd
import xarray as xr

from ..core.claims import all_claims, claims_of
from ..core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED
from ..study.figure_list import SPECIMEN, all_figures

#: Sign of each verdict, and the class of its colour.
SIGNS = {
    HOLDS: ("●", "holds"),
    PARTLY: ("◐", "partly"),
    FAILS: ("○", "fails"),
    UNDETERMINED: ("?", "open"),
    ILL_POSED: ("×", "open"),
}


#: Words of a verdict, as the stages and the table have them.
_WORDS = ("verdict", "numbers", "note", "explanation", "judged_on")


@dataclass(frozen=True)
class Cell:
    """Verdict on a statement, with its sign and the class of its colour.

    ``numbers`` decide it, ``note`` and ``explanation`` (what a null model does in the same data)
    stand beside them. It is judged on the specimen, or on realisations of its kind. ``circular``
    says how the specimen was chosen for it; ``figure`` is the name of one that shows it. Both may
    be empty. It is not ``counted`` if it checks the solver or the rules, or repeats another.
    """

    verdict: str
    numbers: str
    note: str
    explanation: str
    judged_on: str
    circular: str
    figure: str
    counted: bool

    @property
    def sign(self) -> str:
        """Sign of the verdict."""
        return SIGNS[self.verdict][0]

    @property
    def kind(self) -> str:
        """Class of its colour."""
        return SIGNS[self.verdict][1]


@dataclass(frozen=True)
class Row:
    """Statement, the rule that judges it, and its verdicts by specimen."""

    name: str
    figure: str
    claim: str
    rule: str
    cells: dict[str, Cell]


def matrix_of(atlas: xr.DataTree, specimens: Sequence[str]) -> list[Row]:
    """Statements that are asked of any of the specimens, in the order of the paper."""
    tables = {name: atlas[f"statements/{name}"].to_dataset() for name in specimens}
    return [row for claim in claims_of("one").values() if (row := _row(claim, tables)).cells]


def merged(matrices: Iterable[Iterable[Row]]) -> list[Row]:
    """Statements of several specimens together, in the order of the paper."""
    rows: dict[str, Row] = {}
    for row in (row for matrix in matrices for row in matrix):
        rows.setdefault(row.name, replace(row, cells={})).cells.update(row.cells)
    return [rows[name] for name in claims_of("one") if name in rows]


def counted(rows: Iterable[Row]) -> dict[str, int]:
    """Counts of the verdicts that count, in the order of :data:`SIGNS`."""
    given = [cell.verdict for row in rows for cell in row.cells.values() if cell.counted]
    return {verdict: given.count(verdict) for verdict in SIGNS if verdict in given}


def controls_of(rows: Iterable[Row]) -> list[str]:
    """Specimens none of whose verdicts counts: worlds whose truth is known."""
    cells = [(name, cell.counted) for row in rows for name, cell in row.cells.items()]
    counting = {name for name, is_counted in cells if is_counted}
    return list(dict.fromkeys(name for name, _ in cells if name not in counting))


def checks_of(rows: Iterable[Row]) -> list[Row]:
    """Statements that no surface can refute."""
    return [row for row in rows if all_claims()[row.name].check]


def of_study(atlas: xr.DataTree) -> list[Row]:
    """Statements that need several specimens: each has one cell, under the empty name."""
    if "study_statements" not in atlas.children:
        return []
    table = atlas["study_statements/study"].to_dataset()
    return [_row(claim, {"": table}) for claim in claims_of("several").values()]


def statement_table(study: str, rows: Iterable[Row]) -> pd.DataFrame:
    """Verdicts as a table, one row a statement and specimen; of several together without a name."""
    records = [
        {
            "study": study,
            "specimen": specimen,
            "statement": row.name,
            "figure": row.figure,
            "claim": row.claim,
            **{name: getattr(cell, name) for name in _WORDS},
            "chosen_for": cell.circular,
            "counted": cell.counted,
        }
        for row in rows
        for specimen, cell in row.cells.items()
    ]
    return pd.DataFrame(records) if records else pd.DataFrame(columns=["study", "specimen"])


def _row(claim, tables):
    asked = {
        specimen: table.sel(statement=claim.name)
        for specimen, table in tables.items()
        if claim.name in table["statement"].values
    }
    cells = {
        specimen: _cell(judged, _figure_of(claim, judged)) for specimen, judged in asked.items()
    }
    rule = next((str(judged["rule"].item()) for judged in asked.values()), "")
    return Row(claim.name, claim.figure, claim.claim, rule, cells)


def _figure_of(claim, judged):
    """The figure that shows a statement; of a surface against a plane many are not drawn."""
    if not claim.shown_in or judged.attrs.get("direction", "") != "none":
        return claim.shown_in
    return claim.shown_in if all_figures()[claim.shown_in].subject == SPECIMEN else ""


def _cell(judged, figure):
    words = {name: str(judged[name].item()) for name in _WORDS}
    circular = str(judged["circular_reason"].item()) if judged["circular"] else ""
    return Cell(**words, circular=circular, figure=figure, counted=bool(judged["counted"]))
