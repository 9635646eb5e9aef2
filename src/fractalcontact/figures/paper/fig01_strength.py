"""Shear strength against the size of the joint, computed (Fig. 1b)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing
from ..kit.empty import say_empty
from ..kit.legends import entries, legends_below
from ..kit.panel import rows
from ..kit.points import hollow_entry
from ..kit.sizes import (
    BARS,
    NO_STRENGTH,
    SHIFTED,
    TRUNCATED,
    draw_over_size,
    logarithmic,
    name_exponents,
    series,
    size_axis,
)
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ..kit.words import percent, place, short

TITLE = "Fig. 1b: shear strength against the size of the joint, at equal offset over size"
SUBJECT = "joint"
NEEDS = ("windows", "statements")
ORDER = 10


def draw(atlas: DataTree, name: str) -> Drawing:
    """Strength and slope of the dilatancy curve against the side b, at one v/b.

    Its data are the means over sub-windows at every v/b, and their peaks.
    """
    subject = Subject.of(atlas, name)
    laws = subject["windows"]
    drawn = laws.sel(share=float(laws["strength_share"]))
    share = percent(float(drawn["share"]))
    figure = Figure(figsize=(WIDTH, 4.6))
    strength, slope = figure.subplots(1, 2)
    letter(strength, "a", f"strength at $v$ = {share} of $b$")
    letter(slope, "b", f"dilatancy at $v$ = {share} of $b$")
    _draw_strength(strength, drawn)
    _draw_slope(slope, drawn)
    legends_below(figure, entries(strength), entries(slope))
    headline(figure, subject.label, place(str(laws["direction"].values)))
    known = drawn["slope_at_equal_v_over_b_exponent"].notnull()
    at_one_v = drawn["slope_at_equal_v_exponent"].values
    words = caption(
        __name__,
        share=float(drawn["share"]),
        trends=drawn["slope_at_equal_v_over_b_trend"].values[known].tolist(),
        at_one_v=sorted(at_one_v[np.isfinite(at_one_v)]),
        lost=int((drawn["slope_at_equal_v_over_b"] <= 0).sum()),
        claim=claim(atlas, name, "strength_falls_with_size"),
    )
    return Drawing(figure, _table(laws), words)


def _draw_strength(axes, laws):
    b = laws["side"].values
    valid = laws["strength_at_equal_v_over_b_valid"]
    draw_over_size(axes, laws, "strength_at_equal_v_over_b", filled=valid)
    for j in range(laws.sizes["normal_force"]):
        style = {"color": series(j)["color"], "lw": 0.8, "ls": "--"}
        axes.plot(b, laws["barton_scaled_strength"].isel(normal_force=j), **style)
    size_axis(axes, b, "joint")
    if np.isfinite(laws["strength_at_equal_v_over_b"]).any():
        name_exponents(axes, laws, "strength_at_equal_v_over_b_exponent", r"\tau")
        logarithmic(axes, laws["strength_at_equal_v_over_b"].values)
        if not valid.all():
            hollow_entry(axes, TRUNCATED)
    else:
        say_empty(axes, NO_STRENGTH, ticks=False)
    if np.isfinite(laws["barton_scaled_strength"]).any():
        axes.plot([], [], color="0.4", ls="--", lw=0.8, label="Barton and Bandis (50 to 400 mm)")
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")


def _draw_slope(axes, laws):
    b = laws["side"].values
    slopes = laws["slope_at_equal_v_over_b"].transpose("part", "normal_force").values
    draw_over_size(axes, laws, "slope_at_equal_v_over_b")
    whole = laws["slope_of_whole_at_equal_v"].transpose("normal_force", "part")
    for j, line in enumerate(whole.where(whole > 0).values):
        axes.plot(b, line, color=series(j)["color"], lw=0.8)
    if (whole > 0).any():
        axes.plot(
            [], [], color="0.4", lw=0.8, label="whole window at the same $v$: no effect of $b$"
        )
    name_exponents(axes, laws, "slope_at_equal_v_over_b_exponent", r"d\delta/dv")
    expected, line = (
        float(laws["expected_hurst"]) - 1,
        laws["slope_at_equal_v_over_b_expected"].values,
    )
    if (known := np.isfinite(line)).any():
        label = rf"self-affine, Hurst exponent $H$: $x = H - 1$ = {short(expected)}"
        axes.plot(b[known], line[known], color="0.5", ls=":", label=label)
    for words in (BARS, SHIFTED):
        axes.plot([], [], " ", label=words)
    size_axis(axes, b, "joint")
    if (slopes > 0).any():
        logarithmic(axes, slopes)
    else:
        say_empty(axes, "no offset lies at one v/b of the sizes", ticks=False)
    axes.set_ylabel(r"slope $d\delta/dv$ of the dilatancy curve (mm/mm)")


def _table(laws):
    """Means at every v/b, then the peaks."""
    means = (
        "strength_at_equal_v_over_b",
        "slope_at_equal_v_over_b",
        "slope_of_whole_at_equal_v",
        "truncated_fraction_at_equal_v_over_b",
    )
    laws = laws.compute().transpose("normal_force", "share", "part", ...)
    every = ("side", "windows", "barton_scaled_strength")
    tables = [
        rows(laws, *means, *every, at="v/b"),
        rows(laws, "peak_strength", "truncated_fraction_at_peak", *every, at="peak"),
    ]
    return pd.concat(tables, ignore_index=True)
