"""Captions of one line taken apart into sentences: for figures whose caption has no parts yet."""

import re
from collections.abc import Sequence

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


def of_sentences(
    caption: str, label: str, warnings: Sequence[str]
) -> tuple[str, list[str], list[str]]:
    """The first sentence that finds something, those on what is drawn, and all that find.

    It opens with what it is after and of what; then it says what is drawn, then what is found.
    Nothing is written anew here.

    Parameters
    ----------
    caption : str
    label : str
        Of its specimen, as the captions have it.
    warnings : sequence of str
        Left out: the page states them once.
    """
    text = caption.strip()
    for warning in ("; ".join(warnings), *warnings):
        if warning:
            text = text.replace(f"WARNING: {warning}.", "")
    text = " ".join(text.split())
    if label:
        text = text.replace(label, _LABEL)
    sentences = [sentence.replace(_LABEL, label) for sentence in _END.split(text) if sentence]
    if not sentences:
        return "", [], []
    counted = len(sentences) > 1 and _COUNTED.match(sentences[1])
    first = 1 if counted else 2
    drawn, found = sentences[:first], sentences[first:]
    return without_opening(_in_words(found[0])) if found else "", drawn, found


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
