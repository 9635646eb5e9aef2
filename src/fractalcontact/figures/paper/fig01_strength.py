"""Shear strength against the size of the joint, computed (Fig. 1b)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate
from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    headline,
    legends_below,
    letter,
    settings_of,
)
from ..kit.empty import say_empty
from ..kit.points import hollow_entry
from ..kit.sizes import (
    HELD,
    MOSTLY,
    NO_STRENGTH,
    SHIFTED,
    along_size,
    apart,
    cases_words,
    draw_bars,
    draw_means,
    interval_text,
    logarithmic,
    share_shown,
    share_words,
    size_axis,
    strength_verdict,
)
from ..kit.verdicts import sentences
from ..kit.words import opening, place, short

TITLE = "Fig. 1b: shear strength against the size of the joint, at equal offset over size"
SUBJECT = "joint"
NEEDS = ("windows", "statements")
ORDER = 10

#: Sizes a comparison needs.
_FEWEST_SIZES = 3


def draw(atlas: DataTree, name: str) -> Drawing:
    """Strength and slope of the dilatancy curve against the side b, at one v/b.

    Its data are the means over sub-windows at every v/b, and their peaks.
    """
    settings = settings_of(atlas, name)
    laws = group(atlas, "windows", name)
    share = share_shown(laws, "similar_slope")
    figure = Figure(figsize=(WIDTH, 4.6))
    strength, slope = figure.subplots(1, 2)
    _draw_strength(strength, laws, share)
    _draw_slope(slope, laws, share)
    legends_below(figure, entries(strength), entries(slope))
    direction = str(laws["direction"].values)
    headline(figure, settings["label"], place(direction))
    falls = strength_verdict(atlas, name, laws, share)
    return Drawing(figure, _table(laws), _caption(laws, share, falls))


def _draw_strength(axes, laws, share):
    b, loads = laws["side"].values, laws.sizes["normal_force"]
    drawn = np.isfinite(laws["similar_strength"][share].values).any()
    held = laws["similar_held"].values[share] > MOSTLY
    for j, pressure in enumerate(laws["nominal_pressure"].values):
        colour, marker = colour_of(j + 1), MARKERS[j % len(MARKERS)]
        mean, low, high = along_size(laws.isel(share=share), "similar_strength", (j,))
        beside = apart(b, j, loads)
        draw_means(axes, beside, mean, laws["similar_held"].values[share, :, j], colour, marker)
        draw_bars(axes, beside, mean, low, high, colour)
        barton = laws["barton_scaled_strength"].values[:, j]
        axes.plot(b, barton, color=colour, lw=0.8, ls="--")
        if drawn:
            style = {"color": colour, "marker": marker, "ls": "none"}
            exponent = interval_text(laws, "similar_strength_exponent", (share, j))
            label = rf"$\sigma_0$ = {short(pressure)} MPa: $\tau \sim b^x$, $x$ = {exponent}"
            label = label.replace("no fit", "no fit (held)" if held[:, j].any() else "no fit")
            axes.plot([], [], **style, label=label)
    size_axis(axes, b, "joint")
    if drawn:
        logarithmic(axes, laws["similar_strength"].values[share])
        if held.any():
            hollow_entry(axes, HELD)
        if cases := cases_words(laws, share):
            axes.plot([], [], " ", label=cases)
    else:
        say_empty(axes, NO_STRENGTH, ticks=False)
    if np.isfinite(laws["barton_scaled_strength"]).any():
        axes.plot([], [], color="0.4", ls="--", lw=0.8, label="Barton and Bandis (50 to 400 mm)")
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")
    letter(axes, "a", f"strength at $v$ = {share_words(laws, share)} of $b$")


def _draw_slope(axes, laws, share):
    b, loads = laws["side"].values, laws.sizes["normal_force"]
    drawn = False
    for j, pressure in enumerate(laws["nominal_pressure"].values):
        style = {"color": colour_of(j + 1), "marker": MARKERS[j % len(MARKERS)]}
        mean, low, high = along_size(laws.isel(share=share), "similar_slope", (j,))
        beside = apart(b, j, loads)
        positive = mean > 0
        drawn |= positive.any()
        axes.plot(beside[positive], mean[positive], **style, ls="none")
        draw_bars(axes, beside, mean, low, high, style["color"])
        exponent = interval_text(laws, "similar_slope_exponent", (share, j))
        label = rf"$\sigma_0$ = {short(pressure)} MPa: $d\delta/dv \sim b^x$, $x$ = {exponent}"
        axes.plot([], [], **style, ls="none", label=label)
    expected = float(laws["expected_hurst"]) - 1
    slopes = laws["similar_slope"].values[share]
    anchored = np.isfinite(slopes).all(axis=1) & (slopes > 0).all(axis=1)
    if np.isfinite(expected) and anchored.sum() >= _FEWEST_SIZES:
        side = b[anchored]
        level = np.exp(np.mean(np.log(slopes[anchored])))
        middle = np.exp(np.mean(np.log(side)))
        label = rf"self-affine, Hurst exponent $H$: $x = H - 1$ = {short(expected)}"
        axes.plot(side, level * (side / middle) ** expected, color="0.5", ls=":", label=label)
    axes.plot([], [], " ", label="bars: 95 % intervals; none of the whole window")
    axes.plot([], [], " ", label=SHIFTED)
    size_axis(axes, b, "joint")
    if drawn:
        logarithmic(axes, laws["similar_slope"].values[share])
    else:
        say_empty(axes, "no offset lies at one v/b of the sizes", ticks=False)
    axes.set_ylabel(r"slope $d\delta/dv$ of the dilatancy curve (mm/mm)")
    letter(axes, "b", f"dilatancy at $v$ = {share_words(laws, share)} of $b$")


def _table(laws):
    tables = []
    for j, pressure in enumerate(laws["nominal_pressure"].values):
        common = {
            "nominal_pressure_MPa": pressure,
            "b_mm": laws["side"].values,
            "windows": laws["windows"].values,
            "barton_scaled_strength_MPa": laws["barton_scaled_strength"].values[:, j],
        }
        for i, share in enumerate(laws["share"].values):
            strength, slope = (
                Estimate.read(laws, name)[i, :, j] for name in ("similar_strength", "similar_slope")
            )
            values = strength.columns("strength_MPa") | slope.columns("similar_slope")
            held = laws["similar_held"].values[i, :, j]
            row = {"at": "v/b", "v_over_b": share, **common, **values, "held_share": held}
            tables.append(pd.DataFrame(row))
        values = Estimate.read(laws, "peak_strength")[:, j].columns("strength_MPa")
        held = laws["held_share"].values[:, j]
        tables.append(pd.DataFrame({"at": "peak", **common, **values, "held_share": held}))
    return pd.concat(tables, ignore_index=True)


# -- caption ---------------------------------------------------------------------------------------


def _caption(laws, share, falls):
    return sentences(
        f"{opening('Fig. 1b')} Strength and slope of dilatancy of sub-windows at "
        f"v = {share_words(laws, share)} of their side b.",
        _slope_words(laws, share),
        falls,
        _limit_words(laws, share),
    )


def _slope_words(laws, share):
    """How often the slope of the dilatancy falls with size beyond its interval."""
    known = np.isfinite(laws["similar_slope_exponent"][share])
    if not known.any():
        return "Too few sizes can be compared at one v/b."
    exponents = Estimate.read(laws.isel(share=share), "similar_slope_exponent")
    falls, rises = int((exponents.high < 0).sum()), int((exponents.low > 0).sum())
    n = int(known.sum())
    if falls == n:
        return f"The slope falls with b under all {n} pressures (intervals of x below 0)."
    words = f"Intervals of x of the slope lie below 0 under {falls} of {n} pressures"
    return f"{words}, above under {rises}." if rises else f"{words}."


def _limit_words(laws, share):
    """The one warning: mean slopes that no logarithm has."""
    lost = int((laws["similar_slope"].values[share] <= 0).sum())
    return f"{lost} mean slopes that are not positive are left out." if lost else ""
