"""Dimension of measured contact maps against nominal pressure and against contact fraction."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from .. import kit

TITLE = "Dimension of measured contact maps against pressure"
SUBJECT = "study"
NEEDS = ("contact_maps",)
KEY = "contact_maps"
ORDER = 310

#: Maximum number of series whose trends the caption states.
_IN_WORDS = 2


def draw(atlas: DataTree, specimens: list[str]) -> kit.Drawing:
    """Delta_sigma over sigma_0 and over A_r/A_0, one line a series, beside random cells."""
    series = kit.measured_series(atlas)
    figure = Figure(figsize=(kit.WIDTH, 3.9))
    panels = figure.subplots(1, 2, sharey=True)
    for sample in series:
        kit.draw_series(panels[0], sample, sample.pressure, sample.legend, nulls=True)
        kit.draw_series(panels[1], sample, sample.values("area_share"), sample.legend, nulls=True)
    for axes, which, words in (
        (panels[0], "a", r"nominal pressure $\sigma_0$ (MPa)"),
        (panels[1], "b", "contact fraction $A_r/A_0$ (1)"),
    ):
        axes.set_xlabel(words)
        kit.letter(axes, which, words.split(" $")[0])
    if any(np.isfinite(sample.pressure).any() for sample in series):
        panels[0].set_xscale("log")
    else:
        panels[0].set_xticks([])
        kit.say_empty(panels[0], "no map states its load")
    panels[1].set_xscale("log")
    panels[0].set_ylabel(r"dimension $\Delta_\sigma$ by box counting (1)")
    panels[0].set_ylim(-0.05, 2.05)
    kit.legends_below(figure, kit.entries(panels[1]), _marks(series))
    kit.headline(figure, "bars: 95 % intervals; after each name the number of its maps")
    said = kit.caption(__name__, thresholds=kit.threshold_words(series), trends=_trends(series))
    return kit.Drawing(figure, kit.table_of_maps(series), said)


def _marks(series):
    marks = [
        kit.mark(color="0.3", ls=":", lw=0.8, label="as many random cells"),
        Patch(facecolor="none", edgecolor="0.3", hatch="....", lw=0, label="95 % of their draws"),
    ]
    if any(np.isfinite(each.values("delta_sigma_least")).any() for each in series):
        marks.append(Patch(facecolor="0.3", alpha=0.15, label="band over thresholds"))
    return marks


def _trends(series):
    """Trend of the dimension with pressure, in the longest series."""
    longest = sorted(series, key=lambda each: -len(each.maps))[:_IN_WORDS]
    return [
        {
            "label": each.legend,
            "verdict": str(each.maps[0]["pressure_trend"].values),
            "beyond_random": str(each.maps[0]["pressure_trend_beyond_random"].values),
            "slope": Estimate.read(each.maps[0], "pressure_slope", scale=DIMENSION),
            "less": Estimate.read(each.maps[0], "pressure_slope_beyond_random", scale=DIMENSION),
        }
        for each in longest
    ]
