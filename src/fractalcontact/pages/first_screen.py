"""First screen of a result page: one block of first numbers for each joint, from the register."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..core.determined import decided_by_scan
from ..core.estimate import Estimate
from ..core.labels import BOUNDARIES, OPPOSITE, printable
from ..core.limits import ALL_CRUSH, JRC_SAMPLING, PRESSURE_ROUNDING
from ..core.subject import Subject
from ..core.text import measured, percent, short, with_unit
from ..report.published import Number, Row, is_of_law, read, read_at, row_of
from .files import CARD
from .lights import trust_in
from .summary import STRENGTH_RULES, lengths_of

#: Interval, as the register names it, of which the first screen says whether it holds the scans.
_OF_SURFACE = "all errors of this surface"
_ALL_CRUSH = "all contacts crush: pressure over hardness, whatever the scan"
#: Space that keeps an interval on one line.
_NBSP = "\u00a0"
#: What the rules are, a line each for those computed here and those measured by others.
_EXPLAINED = (
    "dilatancy and contact are computed for this window, where nothing breaks: friction angle plus "
    "the steepest rise of the faces, or plus the dips that bear the force",
    "Barton, and Barton and Bandis with its change with length, were measured in shear tests, from "
    "JRC of the face, wall strength and friction angle",
)
#: Rms slope of the gap above which the local cubic law is not valid.
_STEEP_GAP = 1.0


class Fact(NamedTuple):
    """Number of a block: its title, its value in words, and what stands below it, a line each."""

    title: str
    words: str
    notes: list[str]


def block_of(subject: Subject, synthetic: bool) -> dict[str, Any]:
    """Block of a joint; ``facts`` is a list of :class:`Fact`."""
    return {
        "name": subject.name,
        "label": printable(subject.label),
        "synthetic": synthetic,
        "offset": offset_words(subject, synthetic),
        "model": model_of(subject),
        "window": window_words(subject),
        "facts": facts_of(subject, synthetic),
        "trust": trust_in(subject, synthetic),
    }


def is_synthetic(name: str, study: Mapping[str, Any]) -> bool:
    """True if the study generates a specimen: a twin of a scan, or a mathematical joint."""
    return name in study.get("embedded", {})


def quoted_methods(name: str, folder: Path) -> dict[str, Any]:
    """Methods paragraph of a card and its references; empty of a specimen without a card."""
    path = folder / CARD.format(specimen=name, ending="json")
    if not path.is_file():
        return {}
    card = json.loads(path.read_text(encoding="utf-8"))
    return {key: card[key] for key in ("methods", "references")}


def model_of(subject: Subject) -> str:
    """Contact model: elastic, or with the pressure capped at the hardness."""
    hardness = float(subject.settings["material"]["hardness"])
    return f"crushing at H = {with_unit(hardness, 'MPa')}" if math.isfinite(hardness) else "elastic"


def window_words(subject: Subject) -> str:
    """Sides, spacing and boundary of the window of a joint, and how they were chosen."""
    lengths, note = lengths_of(subject), subject["specimens"].attrs["window_note"]
    sides = f"{short(lengths['window_x'])} × {short(lengths['window_y'])} mm"
    chosen = f": {note}" if note else ""
    spacing = with_unit(lengths["spacing"], "mm")
    return f"window {sides}, {boundary_of(subject)}, spacing {spacing}{chosen}"


def boundary_of(subject: Subject) -> str:
    """Boundary of the window in words: what lies beyond its edges."""
    return BOUNDARIES[subject.settings.get("boundary", "free")]


def offset_words(subject: Subject, synthetic: bool = False) -> str:
    """Offset of a joint in words; that of one scanned face is assumed."""
    if subject.direction == "none":
        return "without sliding"
    if subject.offset:
        words = f"{with_unit(subject.offset, 'mm')} towards {subject.direction}"
        # Nobody measured how far a face that was scanned alone had slid.
        one_face = subject["specimens"].attrs["opposite"] == "match" and not synthetic
        return f"assumed offset {words}" if one_face else f"slid by {words}"
    faces = OPPOSITE[subject["specimens"].attrs["opposite"]]
    return "in the mated position" if faces.startswith("one") else "at no offset"


def facts_of(subject: Subject, synthetic: bool = False) -> list[Fact]:
    """First numbers of a joint, five at most, all under the reference load of its study."""
    pressure = float(subject["closure"]["nominal_pressure"][subject.reported.reference])
    at, block = f"at {short(pressure)} MPa", _Block(subject, synthetic)
    facts = [
        block.fact(f"normal stiffness {at}", "interface_stiffness", "MPa/mm", block.at_twice()),
        block.closure(f"closure {at}"),
        block.fact(f"mean gap {at}", "mean_gap", "mm", block.flow()),
    ]
    if subject.direction != "none":
        return [*facts, block.jrc(), block.strength(f"shear strength {at}")]
    # The corrected area is never below F/H: where the raw one is not, contacts all crush.
    crushed = block.hardness * _value(block.number("area_share")) / pressure
    all_crush = _ALL_CRUSH if abs(crushed - 1) < ALL_CRUSH else ""
    return [*facts, block.fact(f"contact {at}", "contact_fraction", "%", all_crush)]


class _Block:
    """Facts of one joint, from its published numbers under the reference load."""

    def __init__(self, subject: Subject, synthetic: bool):
        self.subject, self.synthetic = subject, synthetic
        self.hardness, self.hardest = (
            self.number(name).value for name in ("hardness", "hardest_hardness")
        )

    def number(self, name: str) -> Number:
        return read_at(row_of(name), self.subject)

    def fact(self, title: str, name: str, unit: str, beside: str = "") -> Fact:
        """Number of a row; below it one interval and the number for harder contacts."""
        return self.written(title, row_of(name), self.number(name), unit, beside)

    def written(self, title: str, row: Row, number: Number, unit: str, beside: str) -> Fact:
        """Number in words and what stands below it; a dash with the reason where it is missing."""
        if number.missing:
            return Fact(title, "–", list(filter(None, (number.missing, beside))))
        # A number and its interval have one unit, the same in all blocks.
        size, shown = (100.0, " %") if unit == "%" else (1.0, f" {unit}".removesuffix(" 1"))
        words = f"{short(size * number.value)}{shown}"
        if not number.determined:
            reason = str(number.estimate.reason) or number.remark
            return Fact(title, "undetermined", list(filter(None, (f"{words}: {reason}", beside))))
        notes = (
            self._interval(row, number, size),
            self._harder(number, size),
            self._at_offsets(row, size, shown),
            beside,
        )
        return Fact(title, words, list(filter(None, notes)))

    def closure(self, title: str) -> Fact:
        """Closure from the seat; from first touch under a load below the seat."""
        if _value(self.number("seated_closure")) > 0:
            seat = with_unit(self.number("seating_pressure").value, "MPa")
            words = f"counted from {seat}{self._why_no_lighter_seat()}"
            return self.fact(title, "seated_closure", "mm", words)
        return self.fact(title, "interface_closure", "mm", "counted from first touch")

    def _why_no_lighter_seat(self) -> str:
        """Clause where suspicious cells carry loads that would seat the joint; "" if not."""
        states = self.subject.states("closure")
        pressure = states["nominal_pressure"].values
        lighter = pressure < float(states["seating_pressure"]) * (1 - PRESSURE_ROUNDING)
        lighter &= pressure >= self.subject.settings["seating_pressure"] * (1 - PRESSURE_ROUNDING)
        if not decided_by_scan(states["suspect_load_share"].values[lighter]).any():
            return ""
        words = ", as suspicious cells of the scan carry most of lighter loads"
        if self.subject["specimens"].attrs.get("outliers") == "fill":
            return words
        return f"{words}; 'outliers: fill' in its sidecar shows what that changes"

    def flow(self) -> str:
        """Hydraulic aperture in words, and what limits it."""
        aperture, slope = (self.number(name) for name in ("hydraulic_aperture", "gap_slope"))
        if aperture.missing:
            return f"no hydraulic aperture: {aperture.missing}"
        words = f"hydraulic aperture {short(aperture.value)} mm {_ends(aperture)}".rstrip()
        if not aperture.determined:
            words = f"hydraulic aperture undetermined ({short(aperture.value)} mm)"
        steep = f"cubic law not valid (gap slope {short(slope.value)})"
        limits = (
            "" if aperture.determined else aperture.remark,
            "absolute aperture not compared with tests",
            steep if _value(slope) > _STEEP_GAP else "",
        )
        return "; ".join(filter(None, (words, *limits)))

    def at_twice(self) -> str:
        """Change of the stiffness at twice the spacing, which no interval contains."""
        change = _value(self.number("stiffness_change"))
        is_known = math.isfinite(change) and change != 0
        return f"changes by {percent(change, sign='+')} at twice the spacing" if is_known else ""

    def jrc(self) -> Fact:
        """JRC at the step of its law, in the reported direction."""
        for number in read(row_of("jrc"), self.subject):
            if number.at and is_of_law(number.at, self.subject.direction):
                step = with_unit(number.at["step"], "mm")
                by = f"by Tse and Cruden at a step of {step}; they used {JRC_SAMPLING}"
                by = f"whole face, brackets: 95 % of its profiles; {by}"
                return self.written("JRC", row_of("jrc"), number, "1", by)
        return Fact("JRC", "–", ["no profile is long enough"])

    def strength(self, title: str) -> Fact:
        """Range of the rules for the strength, then each rule with its own error.

        No rule's error is that of the strength: the rules differ by more.
        """
        numbers = {words: self.number(name) for name, words in STRENGTH_RULES.items()}
        missing = {words: number.missing for words, number in numbers.items() if number.missing}
        rules = [(number.value, words) for words, number in numbers.items() if not number.missing]
        rules.sort(key=lambda rule: rule[0])
        if not rules:
            return Fact(title, "–", [missing["dilatancy"]])
        friction = self.number("basic_friction_angle")
        source = str(friction.estimate.reason)
        lines = [f"phi_b = {short(friction.value)}° {source}"] if source else []
        lines += [f"range of {len(rules)} rules:"] if len(rules) > 1 else []
        lines += [f"{of} {short(value)} {_ends(numbers[of])}".rstrip() for value, of in rules]
        lines += [f"no value by {words}: {why}" for words, why in missing.items()]
        lines += [text for text in _EXPLAINED if len(rules) > 1]
        ends = dict.fromkeys(short(value) for value, _ in (rules[0], rules[-1]))
        return Fact(title, f"{' to '.join(ends)} MPa", lines)

    def _holds(self, interval: str) -> str:
        """Clause on what an interval holds: the errors of scans where there are other readings."""
        if interval != _OF_SURFACE:
            return ""
        if self.synthetic:
            return " this surface"
        sources = self.subject["error_budget"]["source"].values
        return (
            " with the errors of both scans"
            if "scan" in sources
            else " of these heights as gridded"
        )

    def _interval(self, row: Row, number: Number, size: float) -> str:
        """One interval: with other windows of the joint where their spread is below the number."""
        ends = _ends(number, size, self._holds(row.interval))
        if not math.isfinite(number.population):
            return ends
        if number.population > abs(number.value):
            solved = self.synthetic or self.subject.settings.get("twins")
            remedy = "" if solved else "; 'twins: 20' in its sidecar narrows this"
            words = f"other windows of the joint may differ by any amount{remedy}"
            return "; ".join(filter(None, (ends, words)))
        whole = Estimate.about(number.value, number.population, *row.bounds)
        _, own_low, own_high = number.estimate.ends
        low = float(size * np.fmin(whole.ends[1], own_low))
        high = float(size * np.fmax(whole.ends[2], own_high))
        return f"[{measured(low)},{_NBSP}{measured(high)}] whole joint"

    def _at_offsets(self, row: Row, size: float, shown: str) -> str:
        """Range of a number over the other offsets of one scanned face, whose own is assumed."""
        specimen, reported = self.subject["specimens"], self.subject.reported
        if row.stage != "closure" or self.synthetic or specimen.attrs["opposite"] != "match":
            return ""
        if row.name == "seated_closure":  # each offset has a seat of its own
            return ""
        curve = reported.curves(self.subject[row.stage])[row.variable]
        values = size * curve.sel(normal_force=reported.force, method="nearest")
        others = values.where((values["offset"] > 0) & (values["offset"] != reported.offset))
        others = others.dropna("offset")
        if not others.size:
            return ""
        ends = " to ".join(dict.fromkeys(short(float(of)) for of in (others.min(), others.max())))
        offsets = [short(float(others["offset"][end])) for end in (0, -1)]
        return f"{ends}{shown} at other offsets ({' to '.join(dict.fromkeys(offsets))} mm)"

    def _harder(self, number: Number, size: float) -> str:
        """A number for the largest hardness of single contacts; empty where contact is elastic."""
        if not math.isfinite(number.hardest):
            return ""
        value, times = short(size * number.hardest), short(self.hardest / self.hardness)
        return f"{value} if contacts are {times} times as hard"


def _value(number: Number) -> float:
    """Value of a number; NaN where it is no result."""
    return math.nan if number.missing else number.value


def _ends(number: Number, size: float = 1.0, of: str = "") -> str:
    """Interval of a number, and what it is of; empty if it is narrower than it prints."""
    ends = number.estimate.ends[1:]
    low, high = (measured(size * end) if math.isfinite(end) else "" for end in ends)
    return f"[{low},{_NBSP}{high}]{of}" if low != high else ""
