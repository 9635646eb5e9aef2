"""Peak and residual strength over the nominal pressure, with Barton's law: a panel of strength."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D

from ...core.estimate import Estimate
from ...core.limits import LARGEST_FRICTION_ANGLE
from ..kit.drawing import COLOURS
from ..kit.empty import say_empty
from ..kit.legends import heading
from ..kit.panel import Panel
from ..kit.points import draw_points, hollow_entry
from ..kit.sizes import draw_bars, logarithmic, roughness_words

#: What (c) shows: variable, words and style.
_SUMMARY: dict[str, tuple[str, dict[str, Any]]] = {
    "peak_strength": (
        "peak over the offsets",
        {"ls": "none", "marker": "o", "ms": 6, "color": "k"},
    ),
    "peak_contact_strength": (
        "peak from the contact itself",
        {"ls": "none", "marker": "^", "ms": 4, "color": COLOURS[1]},
    ),
    "residual_strength": (
        "residual; bar: 95 % interval, if known",
        {"ls": "none", "marker": "D", "ms": 3.5, "color": COLOURS[4]},
    ),
    "barton_strength": (
        f"peak by Barton, at most {LARGEST_FRICTION_ANGLE:g}°, JRC of the scan",
        {"ls": "--", "color": "k"},
    ),
    "barton_scaled_strength": (
        "peak by Barton and Bandis, for this length",
        {"ls": "-.", "color": "k"},
    ),
}
#: Which of them are results, and no bounds.
_VALID = {
    "peak_strength": "peak_strength_valid",
    "peak_contact_strength": "peak_contact_valid",
}


def draw_summary(panel: Panel, strength: xr.Dataset) -> None:
    """Strengths by every law over sigma_0; hollow where it is no result."""
    axes = panel.axes
    axes.set_xlabel(r"nominal pressure $\sigma_0$ (MPa)")
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")
    keep = ("peak_offset", *_VALID.values(), *_SUMMARY)
    panel.keep(strength, *keep, "peak_over_barton")
    known = {name: strength[name].values for name in _SUMMARY if np.isfinite(strength[name]).any()}
    if not known:
        say_empty(axes, why_none(strength), ticks=False)
        return
    sigma = strength["nominal_pressure"].values
    for name, (words, style) in _SUMMARY.items():
        if name in known:
            truncated = np.zeros(sigma.shape, bool)
            if name in _VALID:
                truncated = ~strength[_VALID[name]].values.astype(bool)
            label = None if truncated.all() else words
            draw_points(axes, sigma, known[name], ~truncated, label=label, **style)
            if truncated.any():
                why = "excluded" if name == "peak_strength" else "a lower bound"
                hollow_entry(axes, f"{words}: {why}", **style)
    bars = Estimate.read(strength, "residual_strength").ends
    draw_bars(axes, sigma, *bars, _SUMMARY["residual_strength"][1]["color"])
    axes.set(xscale="log")
    logarithmic(axes, np.array(list(known.values())))


def scan_entries(strength: xr.Dataset) -> list[Line2D]:
    """Entry of a legend: the JRC of the scan, if known."""
    if not np.isfinite(strength["jrc_used"]):
        return []
    return [heading(roughness_words(strength).replace("; ", ";\n").replace(" it ", "\nit "))]


def why_none(strength: xr.Dataset) -> str:
    """Why there is no strength at all."""
    if not np.isfinite(float(strength["basic_friction_angle"])):
        return "no strength: the study states\nno basic friction angle"
    one = not strength.sizes["interval"]
    return "no strength: one offset alone" if one else "no strength: no angle is known"
