"""Constants as a plain table: one row a number, for a spreadsheet or any other program."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from ...core.tables import table_text

ENDING = "csv"
#: Labels beside the numbers of a curve.
_BESIDE = (
    "pressure",
    "offset",
    "direction",
    "sampling",
    "step",
    "fit",
    "fit_step",
    "branch",
    "test",
    "rule",
    "length",
)


def table_of(card: Mapping[str, Any]) -> pd.DataFrame:
    """All numbers of a card, one a row, with the reason where one is missing."""
    rows = []
    for key, entry in card["entries"].items():
        over = entry.get("range", {})
        for number in entry.get("values", [entry]):
            at = number.get("at", {})
            rows.append(
                {"joint": card["name"], "key": key, "title": entry["title"]}
                | {name: at.get(name) for name in _BESIDE}
                | {name: number.get(name) for name in ("value", "low", "high", "hardest")}
                | {"unit": entry["unit"], "model": entry["model"], "law": entry.get("law", "")}
                | {"interval": entry.get("interval", "")}
                | {f"range_{name}": over.get(name) for name in ("low", "high", "unit")}
                | {"determined": number.get("determined"), "missing": number.get("missing", "")}
            )
    return pd.DataFrame(rows)


def text_of(card: Mapping[str, Any]) -> str:
    """The table as CSV; pressures in MPa, offsets and steps in mm."""
    return table_text(table_of(card))
