"""Real contact area and its slope kappa beside the classical theories of the same surface."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import LIGHT_LOAD
from ...core.verdicts import UNDETERMINED
from ...mechanics.states import chosen_offset
from ..experiments.area_slope import kappa_lines
from ..kit.drawing import (
    COLOURS,
    WIDTH,
    Drawing,
    entries,
    finest_curves,
    group,
    heading,
    headline,
    label_short_span,
    legends_below,
    letter,
    settings_of,
)
from ..kit.empty import say_empty
from ..kit.points import reach
from ..kit.verdicts import claim, sentences
from ..kit.words import NOMINAL_PRESSURE, number, opening, place, short

TITLE = "Real contact area compared with the classical theories of section 2"
SUBJECT = "specimen"
NEEDS = ("closure", "area", "statements")
ORDER = 60

#: Theories of panel (a): variable, name, colour, line; the full line first, lest it hide others.
THEORIES = (
    ("greenwood_williamson_share", "Greenwood and Williamson", COLOURS[3], "-"),
    ("bush_gibson_thomas_share", "Bush, Gibson and Thomas", COLOURS[1], "--"),
    ("persson_share", "Persson", COLOURS[2], "-."),
    ("majumdar_bhushan_share", "Majumdar and Bhushan", COLOURS[4], (0, (5, 1, 1, 1, 1, 1))),
)

#: Where the fan of Archard's slopes lies, in parts of the axes: left and right end, lower end.
_FAN = 0.52, 0.9, 0.05

_GREY = "0.45"


def draw(atlas: DataTree, name: str) -> Drawing:
    """Area against pressure with every theory, and kappa against reduced pressure."""
    settings = settings_of(atlas, name)
    curves = finest_curves(atlas, name)
    direction = str(curves["direction"].values)
    laws = group(atlas, "area", name).sel(direction=direction)
    offset = _drawn_offset(settings, laws)
    law, curve = laws.sel(offset=offset), curves.sel(offset=offset)
    where = place(direction) if direction == "none" else place(direction, offset)

    figure = Figure(figsize=(WIDTH, 4.6))
    left, right = figure.subplots(1, 2)
    _draw_area(left, curve, law)
    _draw_kappa(right, laws, law)
    letter(left, "a", "real contact area")
    letter(right, "b", r"area slope $\kappa$")
    legends_below(figure, entries(left), [*_kappa_words(law), *entries(right)])
    headline(figure, settings["label"], where)
    many = "over all offsets" if laws.sizes["offset"] > 1 else ""
    many = "at other offsets" if many and str(law["no_corrected_law"].values) else many
    linear = claim(atlas, name, "area_is_linear", why=many)
    caption = sentences(_caption(law), linear)
    return Drawing(figure, _table(curve, law), caption)


def _drawn_offset(settings, laws):
    """The offset of the maps, unless the faces are flush there and have slid elsewhere."""
    offsets = laws["offset"].values
    rough = offsets[np.isfinite(laws["reduced_pressure"]).all("normal_force").values]
    return chosen_offset(settings["map_offset"], rough if rough.size else offsets)


def _draw_area(axes, curve, law):
    pressure = curve["nominal_pressure"].values
    points = {"ls": "none", "marker": "o", "color": COLOURS[0], "zorder": 3}
    enough = curve["area_corrected_resolved"].values
    corrected = 100 * curve["area_corrected_share"].values
    words = "computed, corrected for the perimeter"
    axes.plot(pressure[enough], corrected[enough], label=words, **points)
    axes.plot(pressure, 100 * curve["area_share"], mfc="none", label="computed, raw", **points)
    if not str(law["no_corrected_law"].values):
        exponent = Estimate.read(law, "corrected_exponent", scale=EXPONENT).text()
        axes.plot([], [], " ", label=f"corrected: $A_r \\sim F^m$, $m$ = {exponent}")
    for variable, words, colour, line in THEORIES:
        share = law[variable].values
        drawn = share <= 1  # nothing but Persson's saturates, and beyond A_0 there is no area
        if not drawn.any():
            words = f"{words}: not defined here"
        axes.plot(pressure[drawn], 100 * share[drawn], color=colour, ls=line, lw=1, label=words)
    axes.set_xscale("log")
    axes.set_yscale("log")
    _draw_slopes(axes, law["archard_exponent"].values, law["archard_level"].values)
    for axis in (axes.xaxis, axes.yaxis):
        label_short_span(axis)
    axes.set_xlabel(f"{NOMINAL_PRESSURE} (MPa)")
    axes.set_ylabel("real contact area $A_r/A_0$ (%)")


def _draw_slopes(axes, exponents, levels):
    """Archard's exponents as slopes, from one point below the curves."""
    (x_low, x_high), (y_low, y_high) = np.log10(axes.get_xlim()), np.log10(axes.get_ylim())
    left, right, bottom = _FAN
    start, end = (x_low + part * (x_high - x_low) for part in (left, right))
    base = y_low + bottom * (y_high - y_low)
    for exponent, level in zip(exponents, levels, strict=True):
        top = base + exponent * (end - start)
        label = "Archard, levels 1, 2, 3: slopes 2/3, 8/9, 26/27" if level == levels[0] else None
        axes.plot(
            10 ** np.array([start, end]),
            10 ** np.array([base, top]),
            ":",
            color=_GREY,
            label=label,
            lw=1,
        )
        last = level == levels[-1]
        axes.annotate(
            f"{level}",
            (10**end, 10**top),
            xytext=(3, 2 if last else -2),
            textcoords="offset points",
            va="bottom" if last else "top" if level == levels[0] else "center",
            fontsize=6,
            color=_GREY,
        )
    axes.set_xlim(10**x_low, 10**x_high)
    axes.set_ylim(10**y_low, 10**y_high)


def _draw_kappa(axes, laws, law):
    """Loads of enough nodes: raw and corrected here, corrected at the other offsets."""
    others = laws.sel(offset=laws["offset"] != law["offset"])
    for i in range(others.sizes["offset"]):
        other = others.isel(offset=i)
        axes.plot(
            *_touching(other, "corrected_kappa"),
            color="0.75",
            lw=0.6,
            zorder=1,
            label="corrected, other offsets" if i == 0 else None,
        )
    style = {"color": COLOURS[0], "marker": "o", "lw": 0.7, "zorder": 3}
    axes.plot(*_touching(law, "corrected_kappa"), **style)
    axes.plot(*_touching(law, "kappa"), mfc="none", **style | {"lw": 0})
    _draw_means(axes, law)
    reduced = laws["reduced_pressure"].where(laws["fitted"]).values
    reduced = reduced[np.isfinite(reduced)]
    if reduced.size:
        kappa_lines(axes, reduced, law.attrs, _colours_of_theories())
        label_short_span(axes.xaxis)
    if reduced.max(initial=0) > LIGHT_LOAD:
        axes.axvline(LIGHT_LOAD, color=_GREY, lw=0.6, label="end of light load")
    if not law["fitted"].any():
        say_empty(axes, _no_points(law))
    axes.set_ylim(bottom=0)
    axes.set_xlabel(r"reduced pressure $\sigma_0/(E^* h'_\mathrm{rms})$ (1)")
    axes.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h'_\mathrm{rms}/\sigma_0$ (1)")


def _colours_of_theories():
    """Colour of a theory's kappa: that of its area."""
    of = {variable: colour for variable, _, colour, _ in THEORIES}
    return {"bush": of["bush_gibson_thomas_share"], "persson": of["persson_share"]}


def _draw_means(axes, law):
    """Mean kappas at light load with their intervals, at the left edge."""
    for prefix, face, at in (("corrected_", COLOURS[0], 0.05), ("", "white", 0.02)):
        if str(law[f"no_{prefix}mean_kappa"].values):
            continue
        value, low, high = Estimate.read(law, f"{prefix}mean_kappa").ends
        axes.errorbar(
            [at],
            [value],
            yerr=reach(value, low, high),
            fmt="s",
            color=COLOURS[0],
            mfc=face,
            capsize=2,
            elinewidth=0.8,
            transform=axes.get_yaxis_transform(),
        )


def _touching(law, name):
    """Reduced pressure and one kappa at the loads whose contact has enough nodes."""
    fitted = law["corrected_fitted" if name.startswith("corrected") else "fitted"].values
    return law["reduced_pressure"].values[fitted], law[name].values[fitted]


def _no_points(law):
    return str(law["no_mean_kappa"].values) or "no load with enough nodes in contact"


def _kappa_words(law):
    """Entries of the legend that state the mean kappas."""
    words = [
        Line2D(
            [],
            [],
            ls="none",
            marker="s",
            color=COLOURS[0],
            mfc=face,
            label=f"mean at light load, {words}: {_mean(law, prefix)}",
        )
        for prefix, words, face in (("corrected_", "corrected", "k"), ("", "raw", "white"))
        if not str(law[f"no_{prefix}mean_kappa"].values)
    ]
    return words or [heading("no mean at light load")]


def _mean(law, prefix):
    value, low, high = Estimate.read(law, f"{prefix}mean_kappa").ends
    return (
        Estimate(value, low, high, scale=EXPONENT).text()
        if np.isfinite(low)
        else f"{short(value)} (one load)"
    )


def _table(curve, law):
    """One row a load."""
    columns = {
        "offset_mm": float(law["offset"]),
        "force_N": law["normal_force"].values,
        "nominal_pressure_MPa": curve["nominal_pressure"].values,
        "reduced_pressure": law["reduced_pressure"].values,
        "area_share": curve["area_share"].values,
        "corrected_share": curve["area_corrected_share"].values,
        "kappa": law["kappa"].values,
        "corrected_kappa": law["corrected_kappa"].values,
        "fitted": law["fitted"].values,
        "corrected_fitted": law["corrected_fitted"].values,
        "corrected_light": law["corrected_light"].values,
    }
    return pd.DataFrame(columns | {name: law[name].values for name, *_ in THEORIES})


def _caption(law):
    return (
        f"{opening('Fig. 5')} Contact area and its slope kappa. "
        f"{_law_words(law)} {_between_words(law)}"
    )


def _law_words(law):
    """The exponent of the area beside Archard's levels."""
    reason = str(law["no_corrected_law"].values)
    if reason:
        return f"No power law here ({reason})."
    value, low, high = Estimate.read(law, "corrected_exponent").ends
    fit = Estimate(value, low, high, scale=EXPONENT).text()
    levels = [
        f"{level}"
        for level, exponent in zip(
            law["archard_level"].values, law["archard_exponent"].values, strict=True
        )
        if low <= exponent <= high
    ]
    archard = f"Archard's level {', '.join(levels)}" if levels else "none of Archard's levels"
    return f"A_r ~ F^m, m = {fit}, fits {archard}."


def _between_words(law):
    """Where the mean kappa lies between the theories."""
    reason = str(law["no_corrected_mean_kappa"].values)
    if reason:
        return f"No kappa at light load: {reason}."
    value = float(law["corrected_mean_kappa"])
    mean = _mean(law, "corrected_")
    if mean.startswith(UNDETERMINED):
        return f"kappa at light load is {mean}."
    low, high = law.attrs["persson_kappa"], law.attrs["bush_gibson_thomas_kappa"]
    side = "between" if low <= value <= high else "below both" if value < low else "above both"
    return (
        f"kappa at light load, {mean}, lies {side} Persson's "
        f"{number(low, 3)} and Bush's {number(high, 3)}."
    )
