"""Regular expressions that match many names quickly."""

import re
from collections.abc import Iterable


def alternation(names: Iterable[str]) -> str:
    """Pattern that matches these names only; without names it matches nothing.

    A common beginning of names is written once (a radix tree), so that a match takes time with the
    length of the name. A plain list of ten thousand names would be tried one by one.
    """
    words = sorted(set(names))
    return _branches(words) if words else "(?!)"


def _branches(words: list[str]) -> str:
    """Pattern of sorted, distinct words, branching after their common prefix."""
    first, last = words[0], words[-1]
    same = next(
        (i for i, (a, b) in enumerate(zip(first, last, strict=False)) if a != b),
        min(len(first), len(last)),
    )
    common = first[:same]
    rest = [word[len(common) :] for word in words]
    if rest == [""]:
        return re.escape(common)
    by_letter: dict[str, list[str]] = {}
    for word in rest:
        by_letter.setdefault(word[:1], []).append(word)
    ends = "?" if by_letter.pop("", None) else ""
    inner = "|".join(_branches(group) for group in by_letter.values())
    return f"{re.escape(common)}(?:{inner}){ends}"
