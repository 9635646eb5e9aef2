"""Attributes of atlas variables, and display of untrusted text."""

import re
from collections.abc import Iterable

#: Members of an ensemble: realisations of an embedded specimen, or twins of a scan.
REALISATIONS, TWINS = "realisations", "twins of the scan"
#: Error sources of a number as a property of this surface; other sources concern its population.
OF_SURFACE = ("solver", "numerical", "secant")

#: Words for the other face, by the attribute ``opposite`` of the specimen.
OPPOSITE = {
    "scanned": "both faces scanned",
    "match": "one face given, the other taken as its perfect match",
    "flat": "one face given, against a rigid plane",
    "aperture": "aperture map: the opening between both faces",
}

#: Words for what lies beyond the edges of the window, by the setting ``boundary``.
BOUNDARIES = {
    "free": "alone on half-spaces",
    "periodic": "repeated beyond its edges",
    "mirrored": "mirrored at its edges",
}


def cf_attrs(units: str, long_name: str) -> dict[str, str]:
    """Attributes of a variable with the names of the CF conventions."""
    return {"units": units, "long_name": long_name}


def printable(text: object, longest: int | None = None) -> str:
    """Untrusted text on one line: control characters escaped, the middle left out if it is long.

    ``longest`` is the number of characters.
    """
    text = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(text))
    if longest is None or len(text) <= longest:
        return text
    half = (longest - 1) // 2
    return f"{text[:half]}…{text[-half:]}"


def on_one_line(text: object, longest: int = 200) -> str:
    """Untrusted text on one line, cut to whole words with "…"."""
    text = " ".join(printable(text).split())
    if len(text) <= longest:
        return text
    end = text.rfind(" ", longest // 2, longest)
    return f"{text[: end if end > 0 else longest]} …"


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Sort key of names that orders their numbers by value: 3, 12, 24, 120."""
    parts = re.findall(r"[0-9]+|[^0-9]+", name)
    return [(0, int(part), "") if part[0] in "0123456789" else (1, 0, part) for part in parts]


def listed(names: Iterable[object], most: int = 15) -> str:
    """Names in a sentence; a long list ends with the number of further names."""
    shown = [printable(name, 60) for name in names]
    more = len(shown) - most
    return ", ".join(shown[:most]) + (f" and {more} more" if more > 0 else "")
