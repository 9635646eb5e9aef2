"""Constants that a code takes from a card, and those that it must be given from elsewhere."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ...core.text import short
from ...core.verdicts import TOO_WIDE

#: Factors from the units of a card to metres and pascals.
TO_SI = {"MPa/mm": 1e9, "MPa": 1e6, "mm": 1e-3, "1": 1.0}
UNITS_SI = {"MPa/mm": "Pa/m", "MPa": "Pa", "mm": "m", "1": "-"}


@dataclass(frozen=True)
class Constants:
    """Constants under the keys of a code, in its units, with notes on each.

    ``left_out`` has the keys whose meaning no number of the card has, and why.
    """

    values: dict[str, float] = field(default_factory=dict)
    notes: dict[str, str] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)

    def add(self, key: str, entry: Mapping[str, Any], row: Mapping[str, Any], what: str) -> None:
        """Add a number of a card in SI units, unless it is missing or undetermined."""
        if "missing" in row:
            self.left_out[key] = f"{what}: {row['missing']}"
        elif not row.get("determined", True):
            reason = row.get("note") or TOO_WIDE
            self.left_out[key] = f"{what} is undetermined ({in_words(entry, row)}): {reason}"
        else:
            self.values[key] = row["value"] * TO_SI[entry["unit"]]
            self.notes[key] = (
                f"{UNITS_SI[entry['unit']]}; {what} = {in_words(entry, row)}, {entry['model']}"
            )


def in_words(entry: Mapping[str, Any], row: Mapping[str, Any]) -> str:
    """Number with its interval and unit, in the units of the card."""
    low, high = ("" if row[end] is None else short(row[end]) for end in ("low", "high"))
    ends = f" [{low}, {high}]" if low != high else ""
    unit = "" if entry["unit"] == "1" else f" {entry['unit']}"
    return f"{short(row['value'])}{ends}{unit}"


def over_pressure(entry: Mapping[str, Any]) -> str:
    """Numbers of a curve in words, "31.2 degree at 5 MPa, ...", or why there are none."""
    known = [row for row in entry.get("values", ()) if "value" in row]
    if not known:
        rows = entry.get("values", [entry])
        return str(rows[0]["missing"])
    return ", ".join(
        f"{short(row['value'])} {entry['unit']} at {short(row['at']['pressure'])} MPa"
        for row in known
    )


def contact_of(card: Mapping[str, Any]) -> str:
    """Contact model of a card, and what lies beyond the edges of its window."""
    edges = card.get("boundary")
    return f"{card['model']}, window {edges}" if edges else str(card["model"])


def head_of(card: Mapping[str, Any], code: str) -> list[str]:
    """First lines of an export: specimen, contact model, trust."""
    one_line = " ".join(str(card["trust"]["reason"]).split())
    return [
        f"Constants of the joint {card['name']} for {code}, from its card (study {card['study']}).",
        f"Contact: {contact_of(card)}. Trust: {card['trust']['word']} ({one_line}).",
        f"{card['licence']}. Brackets hold 95 % intervals.",
    ]
