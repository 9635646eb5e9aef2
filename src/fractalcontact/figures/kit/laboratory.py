"""Readings of laboratory tests in the panels of the computed curves."""

from typing import Any

import numpy as np

from ...core.estimate import Estimate
from ...core.settings import TEST_COLUMNS
from ...core.subject import Subject
from ...core.text import compact
from .drawing import COLOURS, MARKERS
from .panel import Panel


def draw_tests(panel: Panel, subject: Subject, kind: str, *, turned: bool = False) -> None:
    """Readings of the tests of a kind; of sliding tests those in the reported direction alone.

    Nothing is drawn of a specimen without such tests. `turned` puts the quantity along x.
    """
    for number, label in enumerate(labels_of(subject, kind)):
        test = subject["measured"].sel({f"{kind}_test": label})
        # The ends of the intervals are left out: bars of hundreds of readings would hide them.
        axes = (f"{kind}_{TEST_COLUMNS[kind][0]}", f"{kind}_read")
        data = test[list(axes)].dropna(f"{kind}_reading")
        style: dict[str, Any] = {
            "ls": "none",
            "marker": MARKERS[(3 + number) % len(MARKERS)],
            "ms": 6,
            "mew": 0.8,
            "mfc": "none",
            "color": COLOURS[(3 + 2 * number) % len(COLOURS)],
            "zorder": 1,
        }
        panel.curve(data, *(axes[::-1] if turned else axes), label=f"test: {label}", **style)


def labels_of(subject: Subject, kind: str) -> list[str]:
    """Tests of a kind that the figures of a specimen show."""
    if "measured" not in subject.stages or f"{kind}_test" not in subject["measured"]:
        return []
    stage = subject["measured"]
    pairs = zip(stage[f"{kind}_test"].values, stage[f"{kind}_direction"].values, strict=True)
    return [str(label) for label, towards in pairs if towards in ("", subject.direction)]


def test_words(subject: Subject, kind: str) -> list[str]:
    """Sentences of a caption that compare the computed curve with tests of a kind."""
    sentences = []
    for label in labels_of(subject, kind):
        test = subject["measured"].sel({f"{kind}_test": label})
        last = Estimate.read(test, f"{kind}_ratio_at_last")
        if np.isfinite(last.value):
            ends = f"{compact(last.value)} [{compact(last.low)}, {compact(last.high)}]"
            sentences.append(f"{label}: {ends}")
    return sentences
