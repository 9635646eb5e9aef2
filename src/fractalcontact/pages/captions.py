"""Captions of figures on the pages: their parts, and symbols as printed."""

import re
from typing import NamedTuple

from markupsafe import Markup, escape

_GREEK = {
    "Delta": "Δ",
    "delta": "δ",
    "sigma": "σ",
    "phi": "φ",
    "tau": "τ",
    "kappa": "κ",
    "beta": "β",
    "alpha": "α",
}
_SYMBOL = re.compile(
    rf"\b({'|'.join(_GREEK)}|[A-Za-z])_((?:{'|'.join(_GREEK)}|[a-z]{{1,3}}|[A-Z]|\d)\b)"
)
#: h'_rms, after escaping.
_PRIME = re.compile(r"\bh(?:&#39;|')_(\w+)")
_ALONE = re.compile(r"(?<![\w;&])(alpha|beta|kappa|sigma|delta)(?=\*|\b)(?!-)")
_UNIT = re.compile(r"\b(mm|cm|m)([23])\b")
_POWER = re.compile(r"\^(-?\([^()]*\)|-?[\w.]*\w)")


class Caption(NamedTuple):
    """Caption in parts: finding (may be empty), what is drawn, and what is found, in sentences."""

    finding: str
    text: list[str]
    rest: list[str]


def take_apart(caption: str) -> Caption:
    """Parts of a caption file: heading, empty line, one sentence a line.

    A file without an empty line says what is drawn alone.
    """
    heading, parts, lines = caption.rstrip("\n").partition("\n\n")
    if not parts:
        return Caption("", [heading] if heading else [], [])
    shown, *findings = lines.splitlines()
    return Caption(heading, [shown], findings)


def symbols(text: object) -> Markup:
    """Text with its symbols as printed: Delta_g as Δ with a lowered g, mm2 as mm².

    It may be untrusted input, and is escaped first.
    """
    safe = str(escape(text))
    safe = _SYMBOL.sub(_lowered, safe)
    safe = _PRIME.sub(r"h′<sub>\1</sub>", safe)
    safe = _ALONE.sub(lambda match: _GREEK[match[1]], safe)
    safe = _UNIT.sub(lambda match: match[1] + "²³"["23".index(match[2])], safe)
    return Markup(_POWER.sub(lambda match: f"<sup>{match[1]}</sup>", safe))


def _lowered(match):
    base, index = match.groups()
    return f"{_GREEK.get(base, base)}<sub>{_GREEK.get(index, index)}</sub>"
