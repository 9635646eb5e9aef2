"""Eq. 6 in its own form: sigma_0 of parts of the window at the sigma* of the whole, over b."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.subject import Subject
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing
from ..kit.empty import say_empty
from ..kit.legends import heading, legends_below
from ..kit.points import hollow_entry
from ..kit.sizes import plain_decades
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ._size_exponents import draw_measured, draw_predictions, load_axis, size_legends
from ._size_test import (
    ESTIMATORS,
    draw_over_side,
    first_loads,
    place_of,
    rows_of_loads,
    rows_predicted,
    shown_loads,
)

TITLE = "Eq. 6 in its own form: pressure at which parts of the window have the sigma* of the whole"
SUBJECT = "specimen"
NEEDS = ("size_test", "windows", "statements")
ORDER = 171


def draw(atlas: DataTree, name: str) -> Drawing:
    """sigma_0 at equal sigma* over b under some loads, and its slope over the load."""
    subject = Subject.of(atlas, name)
    test = subject["size_test"]
    loads = shown_loads(test, "slope")
    figure = Figure(figsize=(WIDTH, 4.1))
    equal, slopes = figure.subplots(1, 2)
    measured = _draw_equal(equal, test, loads)
    _draw_slopes(slopes, test, loads)
    others, laws = size_legends(slopes)
    legends_below(figure, measured + others, laws)
    headline(figure, subject.label, place_of(test))
    judged = "by the size test, at equal sigma_0"
    why = judged if test["decides"].any() else "no load is conclusive by A_r/A_0 at equal sigma_0"
    said = claim(atlas, name, "size_effect_follows", numbers=False, why=why)
    return Drawing(figure, _table(test), caption(__name__, claim=said, **_words(test)))


def _draw_equal(axes, test, loads):
    """sigma_0 over b at the sigma* of the whole, with the slopes predicted; legend entries."""
    handles = draw_over_side(axes, test, "equal_pressure", "slope", loads)
    axes.set_ylabel(r"nominal pressure $\sigma_0$ (MPa)")
    letter(axes, "a", r"pressure at equal fractal mean pressure $\sigma^*$")
    if not len(loads):
        say_empty(axes, "no load at which three sizes\nhold enough nodes", ticks=False)
        return []
    axes.set_yscale("log")
    drawn = test["equal_pressure"].values[loads]
    axes.set_ylim(np.nanmin(drawn) / 2, np.nanmax(drawn) * 3)
    plain_decades(axes.yaxis)
    return [heading("(a) measured (no intervals), slope [95 % interval]"), *handles]


def _draw_slopes(axes, test, loads):
    """Slopes at equal sigma*, measured and predicted, over the load."""
    draw_predictions(axes, test)
    poor = ~test["well_conditioned"].values.astype(bool)
    draw_measured(axes, test, "slope", loads, poor)
    if (poor & np.isfinite(test["slope"].values)).any():
        words = r"hollow: $\sigma_0$ poorly known from $\sigma^*$"
        hollow_entry(axes, words, color="k", ms=5)
    load_axis(axes, test)
    axes.set_ylabel(r"slope of $\log\sigma_0$ over $\log b$ (1)")
    none = "" if np.isfinite(test["slope"].values).any() else "; no measured slope"
    letter(axes, "b", rf"slope (0: no size effect; eq. 6: $\Delta_\sigma - 2$){none}")


def _table(test):
    tables = [
        rows_of_loads(test, "equal_pressure", "side", "windows", panel="a"),
        rows_of_loads(test, "slope", "slope_n", panel="b"),
        rows_predicted(test),
    ]
    return pd.concat(tables, ignore_index=True)


def _words(test):
    """Best-known slope among the study's loads beside eq. 6's; number of well-conditioned ones."""
    known = np.isfinite(test["slope"].values)
    sure = known & test["well_conditioned"].values.astype(bool)
    counts = {"known": int(known.sum()), "hollow": int(known.sum() - sure.sum())}
    if not known.any():
        return counts
    loads = first_loads(test, "slope")
    loads = loads[sure[loads]] if sure[loads].any() else loads
    width = Estimate.read(test, "slope").width[loads]
    best = test.isel(normal_force=loads[np.argmin(np.where(np.isfinite(width), width, np.inf))])
    predicted = {
        words.replace("$", ""): float(best["predicted_slope"].sel(estimator=estimator))
        for estimator, (_, words) in ESTIMATORS.items()
    }
    return counts | {
        "pressure": float(best["nominal_pressure"]),
        "slope": Estimate.read(best, "slope", scale=DIMENSION),
        "predicted": {words: slope for words, slope in predicted.items() if np.isfinite(slope)},
    }
