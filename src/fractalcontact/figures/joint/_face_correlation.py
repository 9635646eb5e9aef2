"""Correlation of the faces over the offset: a panel of the figure of the compliance."""

from typing import Any

import numpy as np
import xarray as xr

from ..kit.panel import Panel
from ..kit.words import TOWARDS, short


def draw_correlation(
    panel: Panel, joint: xr.Dataset, solved: str, ends: tuple[float, float]
) -> None:
    """The direction solved in black, all others in grey."""
    axes = panel.axes
    others = [d for d in joint["direction"].values if d != solved]
    names = ", ".join(TOWARDS.get(d, d) for d in others)
    kept = ("correlation_length", "uncorrelated_offset")
    grey: dict[str, Any] = {"color": "0.7", "lw": 0.9, "ls": "-", "keep": kept}
    for n, direction in enumerate(others):
        label: dict[str, Any] = {} if n else {"label": f"towards {names}"}
        one = joint.sel(direction=direction)
        panel.curve(one, "rigid_offset", "face_correlation", **grey, **label)
    black: dict[str, Any] = {
        "color": "k",
        "ls": "-",
        "label": f"towards {TOWARDS[solved]}, as in (b), (c)",
    }
    one = joint.sel(direction=solved)
    panel.curve(one, "rigid_offset", "face_correlation", keep=kept, **black)
    limit = float(joint["correlation_limit"])
    if np.isfinite(limit):
        axes.axhspan(-limit, limit, color="0.9", zorder=0, lw=0, label="by chance alone, 95 %")
    # The level and the offsets found from it are lines of one style, here and below.
    axes.axhline(np.exp(-1), color="0.4", lw=0.8, ls="--")
    for at, style, words in zip(ends, ("--", ":"), ("1/e", "lost"), strict=True):
        if np.isfinite(at):
            named = f"correlation {words}: $v$ = {short(at)} mm"
            axes.axvline(at, color="0.4", lw=0.8, ls=style, label=named)
    if not np.isfinite(ends[0]):
        axes.plot([], [], color="0.4", lw=0.8, ls="--", label="correlation 1/e: not reached")
    axes.set_ylim(top=1.05)
    axes.set_ylabel("correlation of the faces (1)")
    axes.set_xlabel("")
