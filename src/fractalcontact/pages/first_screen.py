"""First screen of a result page: one block of first numbers for each joint, from its card."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from ..core.limits import JRC_SAMPLING
from .files import CARD
from .words import measured, short, with_unit

#: Intervals as cards name them, in words.
_ALONE = {"solver": " solver error alone", "all errors of this surface": " this surface"}
#: Where a card has the half-width of a number for other surfaces of its kind.
_KIND = "of_its_population"


class Fact(NamedTuple):
    """Number of a block: its title, its value in words, and its interval or why it is missing."""

    title: str
    words: str
    note: str


@dataclass(frozen=True)
class Block:
    """Block of one joint on the first screen.

    Attributes
    ----------
    name, label : str
    state : str
        Offset of what is quoted, and what the contact was solved as.
    window : str
        Its sides, and how they were chosen.
    facts : list of Fact
    trust : mapping
        ``word``, ``reason`` and ``help``, of the card.
    synthetic : bool
        Made by the study, and no scan.
    methods : str
        Paragraph on how the numbers were found, of the card.
    references : list of str
        What it cites.
    """

    name: str
    label: str
    state: str
    window: str
    facts: list[Fact]
    trust: Mapping[str, str]
    synthetic: bool
    methods: str
    references: list[str]


def blocks_of(names: Sequence[str], folder: Path) -> list[Block]:
    """Blocks of the specimens with a card, scans first.

    Parameters
    ----------
    names : sequence of str
    folder : pathlib.Path
        Of the results.
    """
    paths = [folder / CARD.format(specimen=name, ending="json") for name in names]
    cards = [json.loads(path.read_text(encoding="utf-8")) for path in paths if path.is_file()]
    return sorted((block_of(card) for card in cards), key=lambda one: one.synthetic)


def block_of(card: Mapping[str, Any]) -> Block:
    """Block of one card."""
    return Block(
        name=card["name"],
        label=card["label"],
        state=f"{_offset(card)}; contact {card['model']}",
        window=window_of(card),
        facts=facts_of(card),
        trust=card["trust"],
        synthetic=card["synthetic"],
        methods=card["methods"],
        references=card["references"],
    )


def window_of(card: Mapping[str, Any]) -> str:
    """Sides and spacing of the window of a joint, and how they were chosen."""
    size = {key: one.get("value", math.nan) for key, one in card["geometry"].items()}
    sides = f"{short(size['window_x'])} × {short(size['window_y'])} mm"
    chosen = f": {card['window']}" if card.get("window") else ""
    return f"window {sides}, spacing {with_unit(size['spacing'], 'mm')}{chosen}"


def facts_of(card: Mapping[str, Any]) -> list[Fact]:
    """First numbers of a joint, all at the reference pressure of its study."""
    pressure = reference_of(card)
    at = f"at {short(pressure)} MPa"
    stiffness, seated, gap, hydraulic, contact, strength, barton = (
        row_at(card["entries"][key], pressure)
        for key in (
            *("interface_stiffness", "seated_closure", "mean_gap", "hydraulic_aperture"),
            *("contact_fraction", "peak_strength", "barton_strength"),
        )
    )
    since = f"from {with_unit(card['geometry']['seat'].get('value', math.nan), 'MPa')} on"
    if not seated.get("value"):
        seated, since = row_at(card["entries"]["interface_closure"], pressure), "from first touch"
    flowing = f"hydraulic {short(hydraulic['value'])} mm" if "value" in hydraulic else ""
    facts = [
        _fact(f"normal stiffness {at}", stiffness, "MPa/mm"),
        _fact(f"closure {at}", seated, "mm", since),
        _fact(f"mean gap {at}", gap, "mm", flowing),
        _fact(f"contact {at}", contact, "%"),
    ]
    if card["direction"] != "none":
        beside = f"Barton {with_unit(barton['value'], 'MPa')}" if "value" in barton else ""
        facts.append(_fact("JRC", *_jrc(card)))
        facts.append(_fact(f"peak shear strength {at}", strength, "MPa", beside))
    return facts


def reference_of(card: Mapping[str, Any]) -> float:
    """Reference pressure of a card, MPa; NaN where it has no contact."""
    return float(card["geometry"].get("reference_pressure", {}).get("value", math.nan))


def _offset(card):
    offset = card["geometry"]["offset"]["value"]
    if card["direction"] == "none":
        return "without sliding"
    if offset:
        return f"slid by {with_unit(offset, 'mm')} towards {card['direction']}"
    return "in the mated position" if card["faces"].startswith("one") else "as scanned"


def row_at(curve: Mapping[str, Any], pressure: float) -> dict[str, Any]:
    """Row of a curve of a card at a pressure, MPa, or its absence with the reason."""
    # With the errors that its interval contains.
    beside = {"interval": curve.get("interval", "")}
    rows = [row for row in curve.get("values", ()) if row["at"].get("pressure") == pressure]
    return rows[0] | beside if rows else {"missing": curve.get("missing", "not solved there")}


def _jrc(card):
    """Row of the JRC at the step of its law, in the reported direction, and its step in words."""
    for row in card["entries"]["jrc"].get("values", ()):
        at = row["at"]
        if (at["sampling"], at["direction"]) == (JRC_SAMPLING, card["direction"]):
            return (
                row,
                "1",
                f"at a step of {with_unit(at['step'], 'mm')}; its fit has {JRC_SAMPLING}",
            )
    return {"missing": "no profile is long enough"}, "1", ""


def _fact(title, row, unit, beside=""):
    """Number in words with its interval, or the reason why it is missing, and a remark."""
    if "missing" in row:
        return Fact(title, "–", "; ".join(filter(None, (row["missing"], beside))))
    # One unit for a number and its interval, the same in all blocks.
    size, shown = (100.0, " %") if unit == "%" else (1.0, f" {unit}".removesuffix(" 1"))
    low, high = ("" if row[end] is None else measured(size * row[end]) for end in ("low", "high"))
    words = f"{short(size * row['value'])}{shown}"
    alone = _ALONE.get(row.get("interval", ""), "")
    ends = f"[{low}, {high}]{alone}" if low != high else ""
    kind = f"± {short(size * row[_KIND], 2)} for the whole joint" if _KIND in row else ""
    return Fact(title, words, "; ".join(filter(None, (ends, kind, beside))))
