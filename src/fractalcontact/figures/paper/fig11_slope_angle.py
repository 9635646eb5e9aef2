"""Fig. 11: the limit slope angle against the size of the joint."""

import textwrap
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import ArrayLike
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
    plain_decades,
    roughness_words,
    share_shown,
    share_words,
    size_axis,
    strength_verdict,
)
from ..kit.verdicts import sentences
from ..kit.words import opening, place, short

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
    settings = settings_of(atlas, name)
    laws = group(atlas, "windows", name)
    share = share_shown(laws, "similar_strength")
    figure = Figure(figsize=(WIDTH, 4.4))
    angle, ratio = figure.subplots(1, 2)
    drawn = bool(np.isfinite(laws["similar_strength"].values[share]).all(axis=1).any())
    strength = group(atlas, "strength", name)
    strength = strength.sel(contact_direction=str(laws["direction"].values))
    beyond = _beyond_barton(settings, laws, strength)
    _draw_angle(angle, laws, share, drawn, beyond.rstrip(".").replace(", for", ",\nfor"))
    _draw_ratio(ratio, laws, share, drawn)
    headline(figure, settings["label"], place(str(laws["direction"].values)))
    if drawn:
        legends_below(figure, entries(angle), entries(ratio), columnspacing=2)
    falls = strength_verdict(atlas, name, laws, share)
    caption = _caption(laws, share, drawn, falls, beyond)
    return Drawing(figure, _table(laws), caption)


def slope_angle(strength: ArrayLike, pressure: ArrayLike) -> np.ndarray:
    """Limit slope angle atan(tau / sigma_0), degrees: a block on a plane so steep just slides.

    Parameters
    ----------
    strength, pressure : array_like
        MPa.
    """
    return np.degrees(np.arctan(np.asarray(strength) / pressure))


def _draw_angle(axes, laws, share, drawn, beyond):
    b, pressures = laws["side"].values, laws["nominal_pressure"].values
    for j, pressure in enumerate(pressures):
        colour, marker = colour_of(j + 1), MARKERS[j % len(MARKERS)]
        ends = along_size(laws.isel(share=share), "similar_strength", (j,))
        mean, low, high = (slope_angle(values, pressure) for values in ends)
        beside = apart(b, j, len(pressures))
        draw_means(axes, beside, mean, laws["similar_held"].values[share, :, j], colour, marker)
        draw_bars(axes, beside, mean, np.maximum(low, 0), high, colour)
        barton = slope_angle(laws["barton_scaled_strength"].values[:, j], pressure)
        axes.plot(b, barton, color=colour, lw=0.8, ls="--")
    if (laws["similar_held"].values[share] > MOSTLY).any():
        hollow_entry(axes, HELD)
    if np.isfinite(laws["barton_scaled_strength"]).any():
        axes.plot([], [], color="0.4", ls="--", lw=0.8, label="Barton and Bandis' scale law")
    axes.plot([], [], " ", label=SHIFTED)
    for words in filter(None, (drawn and cases_words(laws, share), beyond)):
        axes.plot([], [], " ", label=textwrap.fill(words, _LINE))
    size_axis(axes, b, "joint")
    axes.set_ylim(0, 90)
    axes.set_ylabel(r"limit slope angle $\arctan(\tau/\sigma_0)$ (degrees)")
    letter(axes, "a", f"angle at $v$ = {share_words(laws, share)} of $b$")
    if not drawn:
        say_empty(axes, NO_STRENGTH, ticks=False)


def _draw_ratio(axes, laws, share, drawn):
    """tau / tau of the whole window, beside the exponent quoted for shear tests."""
    b, pressures = laws["side"].values, laws["nominal_pressure"].values
    for j, pressure in enumerate(pressures):
        values, *ends = along_size(laws.isel(share=share), "similar_strength", (j,))
        colour, marker = colour_of(j + 1), MARKERS[j % len(MARKERS)]
        held = laws["similar_held"].values[share, :, j]
        beside = apart(b, j, len(pressures))
        draw_means(axes, beside, values / values[0], held, colour, marker)
        draw_bars(axes, beside, *(one / values[0] for one in (values, *ends)), colour)
        exponent = interval_text(laws, "similar_strength_exponent", (share, j))
        exponent = exponent.replace("no fit", "no fit (held)") if (held > 0).any() else exponent
        label = rf"$\sigma_0$ = {short(pressure)} MPa: $\tau\sim b^x$, $x$ = {exponent}"
        axes.plot([], [], color=colour, marker=marker, ls="none", label=label)
    slope = QUOTED_DELTA - 2
    label = f"$x$ = {QUOTED_DELTA:g} - 2 = {slope:.2f}, by later work\nof the same school"
    if drawn:
        axes.plot(b, (b / b[0]) ** slope, color="0.3", ls=":", label=label)
    axes.plot([], [], " ", label="bars: 95 % intervals;\nnone of the whole window")
    size_axis(axes, b, "joint")
    axes.set_yscale("log")
    axes.set_ylabel(r"$\tau$ / $\tau$ of the whole window (1)")
    letter(axes, "b", r"strength $\tau$ over that of the whole window")
    ratio = laws["similar_strength"].values[share] / laws["similar_strength"].values[share, 0]
    known = ratio[np.isfinite(ratio) & (ratio > 0)]
    # The whole window may have no strength where its parts have.
    if not (drawn and known.size):
        axes.set_yscale("linear")
        say_empty(axes, "no strength to compare", ticks=False)
        return
    quoted = (b.min() / b[0]) ** slope
    axes.set_ylim(0.7 * min(known.min(), 1), 1.4 * max(known.max(), quoted))
    plain_decades(axes.yaxis)


def _table(laws):
    tables = []
    for i, share in enumerate(laws["share"].values):
        for j, pressure in enumerate(laws["nominal_pressure"].values):
            tables.append(
                pd.DataFrame(
                    {
                        "v_over_b": share,
                        "nominal_pressure_MPa": pressure,
                        "b_mm": laws["side"].values,
                        "windows": laws["windows"].values,
                        **Estimate.read(laws, "similar_strength")[i, :, j]
                        .mapped(partial(slope_angle, pressure=pressure))
                        .columns("angle_deg"),
                        "held_share": laws["similar_held"].values[i, :, j],
                        "barton_angle_deg": slope_angle(
                            laws["barton_scaled_strength"].values[:, j], pressure
                        ),
                        **Estimate.read(laws, "similar_strength_exponent")[i, j].columns(
                            "similar_strength_exponent"
                        ),
                    }
                )
            )
    return pd.concat(tables, ignore_index=True)


# -- caption ---------------------------------------------------------------------------------------


def _caption(laws, share, drawn, falls, beyond):
    first = opening("Fig. 11")
    if not drawn:
        return sentences(
            first,
            "No angle can be given: it needs a basic friction angle and fitting offsets.",
            falls,
        )
    return sentences(
        f"{first} Computed limit slope angle and relative strength of sub-windows at "
        f"v = {share_words(laws, share)} of their side b.",
        falls,
        beyond,
    )


def _beyond_barton(settings, laws, strength):
    """Whether Barton's law was to be drawn, and cannot be: his scale of roughness ends at 20."""
    stated = np.isfinite(settings["material"]["joint_wall_strength"])
    beyond = stated & np.isnan(laws["barton_roughness"]).all()
    return (
        f"The law of Barton and Bandis is not drawn: {roughness_words(strength)}." if beyond else ""
    )
