"""Fig. 11: the limit slope angle against the size of the joint."""

import textwrap

import numpy as np
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
    name_exponents,
    plain_decades,
    roughness_words,
    series,
    size_axis,
)
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ..kit.words import percent, place

TITLE = "Fig. 11: limit slope angle against the size of the joint, computed"
SUBJECT = "joint"
NEEDS = ("windows", "strength", "statements")
ORDER = 180

#: Letters in a line of the legend, of which two columns fit side by side.
_LINE = 48
#: Delta_sigma that later work of the paper's school takes from Bandis' shear tests.
QUOTED_DELTA = 1.66


def draw(atlas: DataTree, name: str) -> Drawing:
    """Limit slope angle of parts of the window against their side b.

    Its data are the angles at every v/b.
    """
    subject = Subject.of(atlas, name)
    laws = subject["windows"]
    direction = str(laws["direction"].values)
    strength = subject["strength"].sel(contact_direction=direction)
    shown = laws.sel(share=float(laws["strength_share"]))
    drawn = bool(shown["strength_at_equal_v_over_b"].notnull().all("normal_force").any())
    # Barton's law was to be drawn, and cannot be: his scale of roughness ends at 20.
    stated = bool(np.isfinite(strength["joint_wall_strength"]))
    beyond = stated and bool(np.isnan(laws["barton_roughness"]).all())
    share, roughness = float(shown["share"]), roughness_words(strength)

    figure = Figure(figsize=(WIDTH, 4.4))
    angle, ratio = figure.subplots(1, 2)
    notes = [f"The law of Barton and Bandis is not drawn: {roughness}"] if beyond else []
    letter(angle, "a", f"angle at $v$ = {percent(share)} of $b$")
    letter(ratio, "b", r"strength $\tau$ over that of the whole window")
    _draw_angle(angle, shown, drawn, notes)
    _draw_ratio(ratio, shown, drawn)
    headline(figure, subject.label, place(direction))
    if drawn:
        legends_below(figure, entries(angle), entries(ratio), columnspacing=2)
    said = claim(atlas, name, "strength_falls_with_size")
    values = {"share": share, "drawn": drawn, "beyond": beyond, "roughness": roughness}
    table = rows(
        laws.transpose("share", "normal_force", "part", ...),
        *(
            "limit_slope_angle",
            "side",
            "windows",
            "truncated_fraction_at_equal_v_over_b",
            "barton_slope_angle",
        ),
        *("relative_strength", "strength_at_equal_v_over_b_exponent"),
    )
    return Drawing(figure, table, caption(__name__, claim=said, **values))


def _draw_angle(axes, laws, drawn, notes):
    b = laws["side"].values
    draw_over_size(axes, laws, "limit_slope_angle", filled=laws["strength_at_equal_v_over_b_valid"])
    for j in range(laws.sizes["normal_force"]):
        barton = laws["barton_slope_angle"].isel(normal_force=j)
        axes.plot(b, barton, color=series(j)["color"], lw=0.8, ls="--")
    if not laws["strength_at_equal_v_over_b_valid"].all():
        hollow_entry(axes, TRUNCATED)
    if np.isfinite(laws["barton_scaled_strength"]).any():
        axes.plot([], [], color="0.4", ls="--", lw=0.8, label="Barton and Bandis' scale law")
    for words in (SHIFTED, *notes):
        axes.plot([], [], " ", label=textwrap.fill(words, _LINE))
    size_axis(axes, b, "joint")
    axes.set_ylim(0, 90)
    axes.set_ylabel(r"limit slope angle $\arctan(\tau/\sigma_0)$ (degrees)")
    if not drawn:
        say_empty(axes, NO_STRENGTH, ticks=False)


def _draw_ratio(axes, laws, drawn):
    """tau / tau of the whole window, beside the exponent quoted for shear tests."""
    b = laws["side"].values
    slope = QUOTED_DELTA - 2
    draw_over_size(axes, laws, "relative_strength", filled=laws["strength_at_equal_v_over_b_valid"])
    name_exponents(axes, laws, "strength_at_equal_v_over_b_exponent", r"\tau")
    if drawn:
        label = f"$x$ = {QUOTED_DELTA:g} - 2 = {slope:.2f}, by later work\nof the same school"
        axes.plot(b, (b / b[0]) ** slope, color="0.3", ls=":", label=label)
    axes.plot([], [], " ", label=textwrap.fill(BARS, _LINE - 10))
    size_axis(axes, b, "joint")
    axes.set_ylabel(r"$\tau$ / $\tau$ of the whole window (1)")
    ratio = laws["relative_strength"].values
    known = ratio[np.isfinite(ratio) & (ratio > 0)]
    # The whole window may have no strength where its parts have.
    if not (drawn and known.size):
        say_empty(axes, "no strength to compare", ticks=False)
        return
    axes.set_yscale("log")
    quoted = (b.min() / b[0]) ** slope
    axes.set_ylim(0.7 * min(known.min(), 1), 1.4 * max(known.max(), quoted))
    plain_decades(axes.yaxis)
