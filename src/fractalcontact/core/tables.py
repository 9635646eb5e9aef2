"""Tables as CSV: the one writer of every table of a study, inert in a spreadsheet."""

from pathlib import Path
from typing import Any

import pandas as pd

from .atomic import atomic_write
from .labels import printable


def table_text(table: pd.DataFrame) -> str:
    """CSV of a table without its index, numbers to eight digits.

    Labels, groups and names come from files of others. Control characters in a text are escaped,
    and one that a spreadsheet would run as a formula (OWASP, "CSV Injection") begins with an
    apostrophe.
    """
    inert = table.copy()
    texts = table.select_dtypes(exclude=["number", "bool"])
    inert[texts.columns] = texts.map(_inert)
    inert = inert.rename(columns=_inert)
    floats = table.shape[1] > 1 and all(kind.kind == "f" for kind in table.dtypes)
    text = (inert[:0] if floats else inert).to_csv(
        index=False, float_format="%.8g", lineterminator="\n"
    )
    if floats:  # formatting here takes a quarter of pandas' time
        row = ",".join(["%.8g"] * table.shape[1]) + "\n"
        text += (row * len(table) % tuple(table.to_numpy(float).ravel().tolist())).replace(
            "nan", ""
        )
    return text


def write_table(path: Path | str, table: pd.DataFrame) -> None:
    """Write a table as :func:`table_text` atomically; OutputError if it cannot be written."""
    with atomic_write(path) as temporary:
        temporary.write_text(table_text(table), encoding="utf-8", newline="")


def _inert(cell: Any) -> Any:
    if not isinstance(cell, str):
        return cell
    shown = printable(cell)
    formula = shown.lstrip()[:1] in tuple("=+-@") and not _is_number(shown)
    return f"'{shown}" if formula else shown


def _is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True
