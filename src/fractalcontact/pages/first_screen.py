"""First screen of a result page: one block of first numbers for each joint, from its card."""

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..core.limits import JRC_SAMPLING
from ..core.text import measured, percent, short, with_unit
from .files import CARD

#: Intervals as cards name them, in words.
_ALONE = {"solver": " solver error alone", "all errors of this surface": " this surface"}
#: Keeps an interval on one line.
_NBSP = "\u00a0"
#: Rules for the peak shear strength, by their entries, in words.
STRENGTH_RULES = {
    "peak_strength": "dilatancy",
    "contact_strength": "contact",
    "barton_strength": "Barton",
    "barton_scaled_strength": "Barton and Bandis",
}
#: Rms slope of the gap above which the local cubic law is not valid.
_STEEP_GAP = 1.0
#: Relative difference from the area of contacts that all crush.
_SAME = 0.01
#: Where a card has the half-width of a number for other surfaces of its kind.
_KIND = "of_its_population"


class Fact(NamedTuple):
    """Number of a block: its title, its value in words, and what stands below it, a line each."""

    title: str
    words: str
    notes: list[str]


def blocks_of(names: Sequence[str], folder: Path) -> list[dict[str, Any]]:
    """Cards of the specimens that have one, scans first, each with what its block prints.

    Parameters
    ----------
    names : sequence of str
    folder : pathlib.Path
        Of the results.
    """
    paths = [folder / CARD.format(specimen=name, ending="json") for name in names]
    cards = [json.loads(path.read_text(encoding="utf-8")) for path in paths if path.is_file()]
    return sorted((block_of(card) for card in cards), key=lambda one: one["synthetic"])


def block_of(card: Mapping[str, Any]) -> dict[str, Any]:
    """A card with its state and window in words, and its ``facts``, a list of :class:`Fact`."""
    state = f"{offset_of(card)}; contact {card['model']}"
    return {**card, "state": state, "window": window_of(card), "facts": facts_of(card)}


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
    stiffness, seated, gap, hydraulic, contact = (
        row_at(card["entries"][key], pressure)
        for key in (
            *("interface_stiffness", "seated_closure", "mean_gap"),
            *("hydraulic_aperture", "contact_fraction"),
        )
    )
    since = f"counted from {with_unit(card['geometry']['seat'].get('value', math.nan), 'MPa')}"
    if not seated.get("value"):
        seated, since = (
            row_at(card["entries"]["interface_closure"], pressure),
            "counted from first touch",
        )
    flowing = _flowing(card, hydraulic, pressure)
    crushed = hardnesses_of(card)[0] * contact.get("value", math.nan)
    by_load = "all contacts crush: sigma_0/H" if abs(crushed / pressure - 1) < _SAME else ""
    facts = [
        _fact(card, f"normal stiffness {at}", stiffness, "MPa/mm", _at_twice(card)),
        _fact(card, f"closure {at}", seated, "mm", since),
        _fact(card, f"mean gap {at}", gap, "mm", flowing),
        _fact(card, f"contact {at}", contact, "%", by_load),
    ]
    if card["direction"] != "none":
        facts.append(_fact(card, "JRC", *_jrc(card)))
        facts.append(_strength(card, f"shear strength {at}", pressure))
    return facts


def _flowing(card, hydraulic, pressure):
    """Hydraulic aperture beside the mean gap, with what to know of it."""
    if "value" not in hydraulic:
        return f"no hydraulic aperture: {hydraulic['missing']}"
    words = f"hydraulic aperture {short(hydraulic['value'])} mm {_ends(hydraulic)}".rstrip()
    slope = row_at(card["entries"]["gap_slope"], pressure).get("value", 0.0)
    steep = f"cubic law not valid (gap slope {short(slope)})" if slope > _STEEP_GAP else ""
    untested = "absolute aperture not compared with tests"
    notes = _harder(card, hydraulic, 1.0), hydraulic.get("note", ""), untested, steep
    return "; ".join(filter(None, (words, *notes)))


def hardnesses_of(card: Mapping[str, Any]) -> tuple[float, float]:
    """Range of the hardness of single contacts, MPa; NaN where contacts are elastic."""
    ends = (card["entries"].get(key, {}) for key in ("hardness", "hardest_hardness"))
    low, high = (one.get("value", math.nan) for one in ends)
    return low, high


def reference_of(card: Mapping[str, Any]) -> float:
    """Reference pressure of a card, MPa; NaN where it has no contact."""
    return float(card["geometry"].get("reference_pressure", {}).get("value", math.nan))


def offset_of(card: Mapping[str, Any]) -> str:
    """Offset of a joint in words."""
    offset = card["geometry"]["offset"]["value"]
    if card["direction"] == "none":
        return "without sliding"
    if offset:
        return f"slid by {with_unit(offset, 'mm')} towards {card['direction']}"
    return "in the mated position" if card["faces"].startswith("one") else "at no offset"


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
            step = with_unit(at["step"], "mm")
            return row, "1", f"by Tse and Cruden at a step of {step}; they used {JRC_SAMPLING}"
    return {"missing": "no profile is long enough"}, "1", ""


def _strength(card, title, pressure):
    """Range of the rules for the strength, then each rule with its own error.

    No rule's error is that of the strength: the rules differ by more.
    """
    rows = {words: row_at(card["entries"][key], pressure) for key, words in STRENGTH_RULES.items()}
    known = {words: row for words, row in rows.items() if "value" in row}
    if not known:
        return Fact(title, "–", [rows["dilatancy"]["missing"]])
    values = sorted(row["value"] for row in known.values())
    lines = [
        f"{words} {short(row['value'])} {_ends(row, of='')}".rstrip()
        for words, row in sorted(known.items(), key=lambda one: one[1]["value"])
    ]
    if len(known) > 1:
        lines.insert(0, f"range of {len(known)} rules:")
    lines += [
        f"no value by {words}: {row['missing']}"
        for words, row in rows.items()
        if words not in known
    ]
    ends = dict.fromkeys(short(value) for value in (values[0], values[-1]))
    return Fact(title, f"{' to '.join(ends)} MPa", lines)


def _fact(card, title, row, unit, beside=""):
    """Number in words, below it its interval, what others of its kind and harder contacts have.

    Or a dash with the reason why it is missing.
    """
    if "missing" in row:
        return Fact(title, "–", list(filter(None, (row["missing"], beside))))
    # One unit for a number and its interval, the same in all blocks.
    size, shown = (100.0, " %") if unit == "%" else (1.0, f" {unit}".removesuffix(" 1"))
    words = f"{short(size * row['value'])}{shown}"
    if not row.get("determined", True):
        return Fact(title, "undetermined", [f"{words}: {row['note']}", *filter(None, (beside,))])
    notes = _ends(row, size), _of_joint(card, row, size), _harder(card, row, size), beside
    return Fact(title, words, list(filter(None, notes)))


def _of_joint(card, row, size):
    """Half-width for the whole joint; larger than the number, it says how little is known."""
    if _KIND not in row:
        return ""
    half = short(size * row[_KIND], 2)
    if row[_KIND] <= abs(row["value"]):
        return f"± {half} for the whole joint"
    remedy = "" if card["synthetic"] else "; 'twins' in the study would narrow it"
    return f"unknown for the whole joint (± {half}{remedy})"


def _ends(row, size=1.0, of=None):
    """Interval of a number, and what it is of; empty if it is narrower than it prints."""
    low, high = ("" if row[end] is None else measured(size * row[end]) for end in ("low", "high"))
    alone = _ALONE.get(row.get("interval", ""), "") if of is None else of
    return f"[{low},{_NBSP}{high}]{alone}" if low != high else ""


def _at_twice(card):
    """Change of the stiffness with the spacing, which no interval contains."""
    change = row_at(card["entries"]["stiffness_change"], reference_of(card)).get("value")
    return f"changes by {percent(change, sign='+')} at twice the spacing" if change else ""


def _harder(card, row, size):
    """A number at both ends of the hardness of single contacts; empty where they are elastic."""
    if "hardest" not in row:
        return ""
    each = row["value"], row["hardest"]
    ends = " to ".join(dict.fromkeys(short(size * value) for value in each))
    soft, hard = hardnesses_of(card)
    return f"{ends} for hardness H to {short(hard / soft)}{_NBSP}H"
