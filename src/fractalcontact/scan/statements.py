"""Statements of a header on the keys of a sidecar, apart from lines that only mention a word.

A line states something if it holds nothing else: ``heights in um``, ``dx = 0.1 mm; dy = 0.2 mm``,
``NODATA_value -9999``. A key that a line mentions among other words is asked of the user, with the
line.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from ..core.labels import printable
from ..core.units import length_unit

#: Longest line that states anything.
_MAX_LINE = 300
_NUMBER = r"[-+]?(?:\d+(?:[.,]\d+)?|[.,]\d+)(?:[eE][-+]?\d+)?"
_WORD = r"[^\W\d_]+"
_UP = {"z", "height", "heights", "value", "values", "elevation", "elevations", "topography"}
_LATERAL = {"x", "y", "xy", "lateral", "coordinates", "coordinate", "positions", "horizontal"}
_ALL = {"all", "length", "lengths", "xyz", "dimensions"}
_NEUTRAL = {"unit", "units", "in", "of", "and", "the", "are"}
_SIGNS = set(",;:=[]()/_&+-.\"'")
_STEP = (
    r"(?:(?:pixel|cell|step)\s?size|(?:(?:pixel|cell|grid|point|sample)\s?)?(?:spacing|step|pitch)"
    r"|sampling\s?(?:step|interval|distance)|increment|inc)"
)
_STEPS = {
    "": re.compile(_STEP),
    "x": re.compile(rf"dx|delta\s?x|x\s?{_STEP}|{_STEP}\s?x"),
    "y": re.compile(rf"dy|delta\s?y|y\s?{_STEP}|{_STEP}\s?y"),
}
_CLAUSE = re.compile(
    rf"\s*(?P<name>[A-Za-z][A-Za-z _-]{{0,30}}?)\s*(?:[\[(]\s*(?P<before>{_WORD})\s*[\])]\s*)?[:=]?"
    rf"\s*(?P<first>{_NUMBER})(?:\s*[x×*]\s*(?P<second>{_NUMBER}))?"
    rf"\s*[\[(]?(?P<behind>{_WORD})?[\])]?\s*(?:[;,]|$)"
)
_LENGTH = re.compile(rf"({_NUMBER})(?:\s*[x×*]\s*({_NUMBER}))?\s*[\[(]?({_WORD})\b")
_MARK = re.compile(
    rf"(?P<name>(?:no[\s_-]?data|missing|invalid|fill|void|blank)[\s_-]?(?P<value>value)?)"
    rf"[\s:=,;\"']+(?P<number>{_NUMBER})[\s\"']*",
    re.IGNORECASE,
)
_ROWS = re.compile(r"first row(?: (?:is|lies))?(?: at(?: the)?)?[\s:=]+(?:at the )?(top|bottom)\W*")
_DOWN = {"depth", "depths", "down", "downward", "downwards"}
_OF_DEPTH = _DOWN | _UP | {"positive", "axis", "is", "are", "points", "point", "increasing"}
#: Words of a line that is shown beside an empty key.
_MENTIONS = {
    "first_row": re.compile(r"\b(?:first row|origin|top|bottom|upper|lower)\b"),
    "heights": re.compile(r"\bdepths?\b|\bdown(?:wards?)?\b"),
    "kind": re.compile(r"apertures?|(?<![a-z])(gaps?|openings?)(?![a-z])"),
    "missing": re.compile(r"no[\s_-]?data|missing|invalid|\bfill|\bvoid\b|\bblank\b"),
    "unit_z": re.compile(r"\b(?:scale|factor|multiplier|gain|lsb)\b.*\d"),
}
_MAX_QUOTED = 3


@dataclass
class Stated:
    """Statements and mentions of a header, by key of a sidecar."""

    #: What lines state, each with its place and text.
    values: dict[str, list[tuple[Any, str]]] = field(default_factory=dict)
    #: Lines with a word of the key among others.
    mentions: dict[str, list[str]] = field(default_factory=dict)
    #: Name, numbers and unit of lengths, and the line.
    lengths: list[tuple[str, list[float], str, str]] = field(default_factory=list)

    def quoted(self, key: str) -> str:
        """Lines that state or mention a key."""
        said = [source for _, source in self.values.get(key, [])] + self.mentions.get(key, [])
        return "; ".join(dict.fromkeys(said[:_MAX_QUOTED]))

    def only(self, key: str) -> tuple[Any, str] | None:
        """Value of a key that every statement agrees on, with its source."""
        values = self.values.get(key, [])
        return values[0] if values and all(v == values[0][0] for v, _ in values) else None


def statements(lines: Iterable[tuple[str, str]]) -> Stated:
    """Statements and mentions in lines of words; a line is its place ("line 3") and its text."""
    stated = Stated()
    steps: dict[str, list[tuple[str, str]]] = {"x": [], "y": []}
    for where, line in lines:
        if len(line) > _MAX_LINE:
            continue
        source = f'{where}: "{printable(line.strip(), 50)}"'
        text = line.lstrip("#%!/;* \t").strip().strip("\"'").strip()
        _read_line(stated, steps, text, source)
    if steps["x"] and steps["y"]:
        pairs = [[x, y] for (x, _), (y, _) in zip(steps["x"], steps["y"], strict=False)]
        sources = [x if x == y else f"{x}, {y}"
                   for (_, x), (_, y) in zip(steps["x"], steps["y"], strict=False)]  # fmt: skip
        stated.values.setdefault("spacing", []).extend(zip(pairs, sources, strict=True))
    else:
        for _, source in steps["x"] + steps["y"]:
            stated.mentions.setdefault("spacing", []).append(source)
    return stated


def _read_line(stated: Stated, steps: dict, text: str, source: str) -> None:
    """Take up one line."""
    lower = text.lower()
    said: dict[str, Any] = {}
    if units := _units(text):
        said |= units
    elif any(length_unit(word) for word in re.findall(_WORD, text)):
        _mention(stated, "unit", source)
    if not _add_steps(said, steps, text, source) and _is_of_steps(lower):
        _mention(stated, "spacing", source)
    if (mark := _MARK.fullmatch(text)) and (mark["value"] or _is_no_data(mark["name"])):
        said["missing"] = float(mark["number"].replace(",", "."))
    if rows := _ROWS.fullmatch(lower):
        said["first_row"] = rows[1]
    words = set(re.findall(_WORD, lower))
    if words & _DOWN and words & {"positive", "heights", "z", "depths"} and words <= _OF_DEPTH:
        said["heights"] = "down"
    for key, value in said.items():
        stated.values.setdefault(key, []).append((value, source))
    for key, pattern in _MENTIONS.items():
        if key not in said and pattern.search(lower):
            _mention(stated, key, source)
    for match in _LENGTH.finditer(text):
        if length_unit(match[3]) and "spacing" not in said:
            numbers = [float(n.replace(",", ".")) for n in match.groups()[:2] if n]
            name = text[: match.start()].strip(" :=")
            stated.lengths.append((name, numbers, match[3], source))


def _mention(stated: Stated, key: str, source: str) -> None:
    stated.mentions.setdefault(key, []).append(source)


def _is_no_data(name: str) -> bool:
    return re.fullmatch(r"no_?data[\s_-]?", name.lower()) is not None


def _is_of_steps(lower: str) -> bool:
    return re.search(r"spacing|step|pitch|pixel|cell ?size|increment|\bd[xy]\b", lower) is not None


def _units(text: str) -> dict[str, str]:
    """Units of a line of names and units alone; {} for any other line."""
    tokens = re.findall(r"[^\W_]+|[^\w\s]|_", text)
    groups: list[tuple[set[str], str]] = []
    names: set[str] = set()
    before = ""
    for number, token in enumerate(tokens):
        word = token.lower()
        follows = before in _SIGNS | {"in", "unit", "units"}
        if follows and length_unit(token) and (word != "in" or number == len(tokens) - 1):
            groups.append((names, token))
            names = set()
        elif word in _UP | _LATERAL | _ALL:
            names.add(word)
        elif word not in _NEUTRAL and token not in _SIGNS:
            return {}
        before = word
    units: dict[str, str] = {}
    for group, unit in groups:
        is_up, is_lateral = bool(group & _UP), bool(group & _LATERAL)
        key = "unit" if is_up == is_lateral else "unit_z" if is_up else "unit_xy"
        if units.setdefault(key, unit) != unit:
            return {}
    return {} if names else units


def _add_steps(said: dict, steps: dict, text: str, source: str) -> bool:
    """Add the spacing of a line of clauses ``name = number unit`` alone; False for any other."""
    clauses, begin = [], 0
    while begin < len(text):
        clause = _CLAUSE.match(text, begin)
        if not clause or (clause["before"] and not length_unit(clause["before"])):
            return False
        clauses.append(clause)
        begin = clause.end()
    is_any = False
    for clause in clauses:
        name = re.sub(r"[\s_-]+", " ", clause["name"].lower())
        unit = clause["behind"] or clause["before"]
        numbers = [n for n in (clause["first"], clause["second"]) if n]
        is_sound = unit and length_unit(unit) and not any(map(_is_doubtful, numbers))
        lengths = [f"{number.replace(',', '.')} {unit}" for number in numbers]
        for axis, pattern in _STEPS.items():
            if is_sound and pattern.fullmatch(name) and len(lengths) <= 2 - bool(axis):
                is_any = True
                if axis:
                    steps[axis].append((lengths[0], source))
                else:
                    said["spacing"] = lengths if len(lengths) == 2 else lengths[0]
    return is_any


def _is_doubtful(number: str) -> bool:
    """True for zero and below, and for digits that may be grouped: 1,250."""
    value = float(number.replace(",", "."))
    return value <= 0 or re.fullmatch(r"[1-9]\d{0,2},\d{3}", number) is not None
