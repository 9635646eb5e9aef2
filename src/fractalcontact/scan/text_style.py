"""Hints of the signs in a text on its delimiter, decimal mark and grouped digits."""

import re

from .draft import Hints
from .options import DELIMITERS
from .text_lines import cells_of

_SAMPLE = 200
#: Largest fraction of ungrouped numbers of four and more digits: marks of missing cells, perhaps.
_MAX_UNGROUPED = 0.1
_DIGITS = re.compile(r"[-+]?\d[\d.,']*(?:[eEdD][-+]?\d+)?")


def add_style(hints: Hints, data: list[str], source: str) -> tuple[str, str, str]:
    """Suggest how numbers are written; a sign that may part thousands is asked.

    Returned are the delimiter by its name, the decimal mark and the thousands mark ("" without).
    """
    name, decimal = _delimiter(data)
    cells = [cell.strip().strip("\"'") for line in data[:_SAMPLE]
             for cell in cells_of(line, DELIMITERS[name])]  # fmt: skip
    numbers = [cell for cell in cells if _DIGITS.fullmatch(cell)]
    thousands = ""
    if name == "comma":
        doubt = any(re.fullmatch(r"0\d+", number) for number in numbers)
        if doubt and not any("." in number for number in numbers):
            for key in ("delimiter", "decimal"):
                hints.ask(key, "do commas part numbers, or are they decimal marks as well?")
    else:
        decimal, thousands = _marks(numbers, decimal)
        if not thousands and (mark := _maybe_grouped(numbers)):
            other = "," if mark == "." else "."
            example = next(number for number in numbers if mark in number)
            hints.ask("decimal", f"{example} may group thousands: then {other!r}, else {mark!r}")
            hints.ask("thousands", f"{mark!r} if it groups digits in {example}, else delete this")
            hints.optional.add("thousands")
    hints.add("delimiter", name, source.replace("in the", "between the"))
    hints.add("decimal", decimal, source)
    if thousands:
        hints.add("thousands", thousands, source)
        hints.optional.add("thousands")
    return name, decimal, thousands


def _delimiter(data: list[str]) -> tuple[str, str]:
    """Delimiter and decimal mark of most lines."""
    sample = data[:_SAMPLE]
    for name in ("tab", "semicolon"):
        if 2 * sum(DELIMITERS[name] in line.strip() for line in sample) > len(sample):
            return name, "," if any("," in line for line in sample) else "."
    if 2 * sum("," in line for line in sample) <= len(sample):
        return "blank", "."
    text = "\n".join(sample)
    has_blanks = re.search(r"\d[ \t]+[-+]?\d", text)
    is_parted = re.search(r",\s", text)
    if has_blanks and not is_parted:
        return "blank", ","
    return "comma", "."


def _marks(numbers: list[str], decimal: str) -> tuple[str, str]:
    """Decimal and thousands marks where a number has both, or one of them twice."""
    if any("'" in number for number in numbers):
        return decimal, "'"
    for number in numbers:
        mantissa = re.split("[eEdD]", number)[0]
        for mark, other in ((",", "."), (".", ",")):
            both = other in mantissa and mantissa.rfind(mark) < mantissa.rfind(other)
            if mark in mantissa and (both or mantissa.count(mark) > 1):
                return other, mark
    return decimal, ""


def _maybe_grouped(numbers: list[str]) -> str:
    """Mark that may part thousands in every number that has it; "" for none."""
    for mark in ".,":
        marked = [number for number in numbers if mark in number]
        others = [number for number in numbers if mark not in number]
        grouped = rf"[-+]?[1-9]\d{{0,2}}(?:{re.escape(mark)}\d{{3}})+"
        whole = [bool(re.fullmatch(r"[-+]?(?:0|[1-9]\d{0,2})", number)) for number in others]
        # A mark of missing cells such as -9999 is often written without thousands signs.
        is_grouped = bool(marked) and all(re.fullmatch(grouped, number) for number in marked)
        if is_grouped and whole.count(False) <= _MAX_UNGROUPED * len(numbers):
            return mark
    return ""
