"""The paper's stages of sliding: verdicts, a column of a legend, numbers along the offset."""

import textwrap
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from xarray import DataTree

from ...core.claims import all_claims
from ...core.verdicts import UNDETERMINED
from ..kit.legends import heading
from ..kit.verdicts import row_of, verdict_words
from ..kit.words import force_label, percent

#: The paper's stages of sliding: what each is said to do, and what decides about it.
STAGES = {
    "compliance_rises_at_first": ("compliance rises as v^x", ""),
    "curves_overlap": (
        "compliance stays the same",
        f"margin {percent(all_claims()['curves_overlap'].margin)}",
    ),
    "compliance_rises_again": (
        "compliance rises again",
        f"margin {percent(all_claims()['compliance_rises_again'].margin, '+')}",
    ),
}
#: Letters of a line of the stages in the legend.
_LINE = 50


def stages_of_sliding(
    atlas: DataTree, name: str, ends: tuple[float, float]
) -> list[tuple[str, str, float, float]]:
    """Statement of the paper on each stage with its verdict, limits, and between which offsets."""
    bounds = ((-np.inf, ends[0]), ends, (ends[1], np.inf))
    found = []
    for (statement, (words, limits)), between in zip(STAGES.items(), bounds, strict=True):
        row = row_of(atlas, "statements", name, statement)
        if row is not None:
            why = "" if str(row["verdict"].item()) == UNDETERMINED else limits
            said = f"{words}: {verdict_words(atlas, name, statement)}"
            found.append((said, why, *between))
    return found


def stage_column(stages: list, force: float) -> list[list[Artist]]:
    """Column of a legend with the stages, in lines that fit; empty without stages."""
    if not stages:
        return []
    words = [f"(c): the paper's stages, 1 judged at $F$ = {force_label(force)}"]
    for n, (text, why, *_) in enumerate(stages, 1):
        said = f"{n}: {text}; {why}" if why else f"{n}: {text}"
        lines = textwrap.wrap(said.replace(" %", "\u00a0%"), _LINE, subsequent_indent="    ")
        words += [line.replace("v^x", "$v^x$") for line in lines]
    return [[heading(line) for line in words]]


def number_stages(axes: Axes, stages: list) -> None:
    """Numbers of the stages at the upper edge, between the offsets that bound them."""
    low, high = axes.get_ylim()
    axes.set_ylim(top=high * (high / low) ** 0.12)
    log = axes.get_xscale() != "linear"
    left, right = axes.dataLim.intervalx if log else axes.get_xlim()
    style: dict[str, Any] = {"ha": "center", "va": "top", "fontweight": "bold"}
    for n, (*_, first, last) in enumerate(stages, 1):
        # One that ends nowhere in the window goes on to its edge.
        first, last = (left if np.isneginf(first) else first), np.fmin(last, right)
        if np.isfinite(first) and 0 <= first < last:
            middle = np.sqrt(first * last) if log and first > 0 else (first + last) / 2
            axes.text(middle, 0.97, f"{n}", transform=axes.get_xaxis_transform(), **style)
