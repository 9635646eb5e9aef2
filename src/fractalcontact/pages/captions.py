"""Captions taken apart: what a figure finds for its heading, two sentences, the rest folded away.

A caption of :mod:`figures` opens with what it is after and of what; then it says what is drawn,
then what is found. Nothing is written anew here.
"""

import re
from collections.abc import Sequence
from typing import NamedTuple

from markupsafe import Markup, escape

#: Where a sentence ends: before a capital, a bracket or a digit, but not after an abbreviation.
_END = re.compile(
    r"(?<!\bFig\.)(?<!\bFigs\.)(?<!\b[Ee]q\.)(?<!\b[Ee]qs\.)(?<!\bal\.)(?<!\bsect\.)(?<!\bvs\.)"
    r"(?<=[.?!])\s+(?=[A-ZΔ(0-9\ue001]|[a-z]+_\w|kappa\b|beta\b)"
)
#: The first words of a caption that no heading repeats.
_OPENING = re.compile(r"(After .*?\(1999\)|Supplementary figure)[:.]\s*")
#: Stands for a label while sentences are sought: it may hold anything.
_LABEL = "\ue001"
#: Tables draw what they find: they are counted at once.
_COUNTED = re.compile(r"(Of \d|Verdicts )")
#: Numbers that a heading leaves to those folded away: an interval, a bracket with digits in it.
_NUMBERS = re.compile(r"\s+(?:\[[^\[\]]*\]|\((?=[^()]*\d)(?:[^()]|\([^()]*\))*\))")

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
    """A caption in parts.

    Attributes
    ----------
    finding : str
        The first sentence that finds something, without numbers in brackets; empty where there is
        none.
    text : list of str
        Of what it is, and what is drawn.
    rest : list of str
        Every other sentence, whole.
    """

    finding: str
    text: list[str]
    rest: list[str]


def take_apart(caption: str, label: str = "", warnings: Sequence[str] = ()) -> Caption:
    """A caption in parts.

    Parameters
    ----------
    caption : str
        As a figure's text file holds it.
    label : str, optional
        Of its specimen, as the captions have it.
    warnings : sequence of str, optional
        Left out: the page states them once.

    Returns
    -------
    Caption
    """
    heading, parts, lines = caption.rstrip("\n").partition("\n\n")
    if parts:
        shown, *found = lines.splitlines()
        return Caption(heading, [shown], found)
    text = caption.strip()
    for warning in ("; ".join(warnings), *warnings):
        if warning:
            text = text.replace(f"WARNING: {warning}.", "")
    text = " ".join(text.split())
    if label:
        text = text.replace(label, _LABEL)
    sentences = [sentence.replace(_LABEL, label) for sentence in _END.split(text) if sentence]
    if not sentences:
        return Caption("", [], [])
    counted = len(sentences) > 1 and _COUNTED.match(sentences[1])
    first = 1 if counted else 2
    drawn, found = sentences[:first], sentences[first:]
    return Caption(_in_words(found[0]) if found else "", drawn, found)


def _in_words(sentence):
    """A sentence without intervals and numbers in brackets; what is circular stays so."""
    short = _NUMBERS.sub("", sentence)
    if "circular" in sentence and "circular" not in short:
        short = f"{short.rstrip('.')} (circular)."
    return short


def without_opening(text: str) -> str:
    """A sentence without "After Fig. 5 of ... (1999):"; it begins with a capital or a symbol."""
    text = _OPENING.sub("", text, count=1)
    return text if re.match(r"\w+_|(?:kappa|beta)\b", text) else text[:1].upper() + text[1:]


def symbols(text: object) -> Markup:
    """Text with its symbols as printed: Delta_g as Δ with a lowered g, mm2 as mm².

    Parameters
    ----------
    text : object
        Escaped first: it may be untrusted input.
    """
    safe = str(escape(text))
    safe = _SYMBOL.sub(_lowered, safe)
    safe = _PRIME.sub(r"h′<sub>\1</sub>", safe)
    safe = _ALONE.sub(lambda found: _GREEK[found[1]], safe)
    safe = _UNIT.sub(lambda found: found[1] + "²³"["23".index(found[2])], safe)
    return Markup(_POWER.sub(lambda found: f"<sup>{found[1]}</sup>", safe))


def _lowered(found):
    base, index = found.groups()
    return f"{_GREEK.get(base, base)}<sub>{_GREEK.get(index, index)}</sub>"
