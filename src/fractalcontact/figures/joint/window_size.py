"""Roughness (eq. 2), closure and compliance (sect. 5) against the size of the window."""

from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.ranges import within
from ...mechanics.states import chosen_offset
from ..kit.drawing import (
    MARKERS,
    WEAK,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    heading,
    headline,
    letter,
    settings_of,
)
from ..kit.empty import say_empty
from ..kit.points import draw_points
from ..kit.sizes import along_size, draw_bars, interval_text, logarithmic, size_axis
from ..kit.verdicts import claim, sentences
from ..kit.words import opening, place, pressure_label

TITLE = "Roughness (eq. 2), closure and compliance (section 5) against the size of the window"
SUBJECT = "specimen"
NEEDS = ("windows", "statements")
ORDER = 90


class Quantity(NamedTuple):
    """What a panel draws of the contact of sub-windows: variables, letter and words."""

    name: str
    exponent: str
    letter: str
    words: str
    label: str


CLOSURE = Quantity(
    "interface_closure",
    "closure_exponent",
    "b",
    "closure",
    r"interface closure $w_\mathrm{int}$ (mm)",
)
COMPLIANCE = Quantity(
    "interface_compliance",
    "compliance_exponent",
    "c",
    "compliance",
    r"compliance $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0$ (mm/MPa)",
)

#: Points that no exponent goes through: beyond the range of eq. 2, or of few nodes in contact.
_HOLLOW = "hollow: not fitted (out of range, few nodes)"


def draw(atlas: DataTree, name: str) -> Drawing:
    """sigma_z, closure and compliance of the interface against the side b of sub-windows.

    Its data are the means over sub-windows with their intervals.
    """
    settings = settings_of(atlas, name)
    laws = group(atlas, "windows", name)
    offsets = laws["offset"].values
    flat = str(laws["direction"].values) == "none"
    mapped = int(np.argmin(np.abs(offsets - chosen_offset(settings["map_offset"], offsets))))
    shown = [] if flat else [mapped]

    figure = Figure(figsize=(WIDTH, 5.8))
    (roughness, closure), (compliance, legends) = figure.subplots(2, 2)
    _draw_roughness(roughness, laws, shown)
    for axes, quantity in ((closure, CLOSURE), (compliance, COMPLIANCE)):
        _draw_contact(axes, laws, mapped, quantity)
    legends.axis("off")
    handles = [
        entry
        for axes, words in (
            (roughness, "(a) exponents with 95 % intervals"),
            (closure, r"(b) $w_\mathrm{int} \sim b^x$ at nominal pressure"),
            (compliance, r"(c) $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0 \sim b^x$"),
        )
        for entry in (heading(words), *entries(axes))
    ]
    fits = [laws[quantity.exponent].values[mapped] for quantity in (CLOSURE, COMPLIANCE)]
    fit = Line2D([], [], color="0.4", label="line: fit (thin: undetermined)", lw=0.8)
    lines = [fit] if np.isfinite(fits).any() else []
    handles += [
        Line2D([], [], ls="none", marker="o", color="0.4", mfc="white", label=_HOLLOW),
        *lines,
        heading("bars: 95 % intervals; none of the whole window"),
    ]
    legends.legend(handles=handles, loc="center left", labelspacing=0.4)
    headline(figure, settings["label"])
    table = pd.concat(
        [
            _roughness_table(laws, shown),
            *(_contact_table(laws, quantity) for quantity in (CLOSURE, COMPLIANCE)),
        ],
        ignore_index=True,
    )
    force = float(group(atlas, "statements", name).attrs["force"])
    judged = laws["nominal_pressure"].sel(normal_force=force, method="nearest")
    exponents = bool(np.isfinite(laws["compliance_exponent"]).any())
    larger = claim(
        atlas,
        name,
        "larger_samples_close_more",
        why=f"at {pressure_label(float(judged))}, filled sizes alone" if exponents else "",
    )
    return Drawing(figure, table, sentences(_caption(laws), _closure_words(laws), larger))


def _draw_roughness(axes, laws, shown):
    b = laws["scale_side"].values
    face = laws["face_sigma_z"].values
    used = laws["scale_used"].values & np.isfinite(face) & np.isfinite(float(laws["face_hurst"]))
    hurst = interval_text(laws, "face_hurst")
    style = {"color": "k", "marker": "o"}
    _with_intervals(axes, b, laws, "face_sigma_z", (), used, **style)
    face_mark = style | _hollow(used)
    axes.plot([], [], **face_mark, ls="none", label=rf"face: $\sigma_z \sim b^H$, $H$ = {hurst}")
    for i in shown:
        style = {"color": "0.65", "marker": "D"}
        _with_intervals(axes, b, laws, "sigma_z_all", (i,), used, **style)
        label = f"gap of both faces: $H$ = {interval_text(laws, 'hurst', i)}"
        axes.plot([], [], **style | _hollow(used), ls="none", label=label)
    expected = float(laws["expected_hurst"])
    if np.isfinite(expected) and used.any():
        ends = b[used][[0, -1]]
        middle = np.exp(np.mean(np.log(b[used])))
        level = np.exp(np.mean(np.log(face[used])))
        label = rf"eq. 2: $H = 3-\Delta_g$ = {interval_text(laws, 'expected_hurst')}"
        axes.plot(ends, level * (ends / middle) ** expected, color="k", ls="--", label=label)
    size_axis(axes, b, "sub-windows")
    if (face > 0).any():
        drawn = [face, *laws["sigma_z_all"].values[shown]]
        logarithmic(axes, np.concatenate(drawn))
    axes.set_ylabel(r"roughness $\sigma_z$ about the own plane (mm)")
    letter(axes, "a", "roughness")


def _draw_contact(axes, laws, mapped, quantity):
    """Closure or compliance over b under every pressure, with the power law of each."""
    b = laws["side"].values
    for j, pressure in enumerate(laws["nominal_pressure"].values):
        style = {"color": colour_of(j + 1), "marker": MARKERS[j % len(MARKERS)]}
        law = quantity.exponent
        exponent = Estimate.read(laws, law, scale=EXPONENT)[mapped, j]
        weak = WEAK if exponent.known and not exponent.determined else {}
        values = laws[quantity.name].values[:, mapped, j]
        fitted = np.zeros(b.shape, bool)
        if exponent.known:
            b_min, b_max = (float(laws[f"{law}_b_{end}"][mapped, j]) for end in ("min", "max"))
            fitted = (values > 0) & within(b, b_min, b_max)
            level = np.exp(np.mean(np.log(values[fitted]) - exponent.value * np.log(b[fitted])))
            line = {"color": style["color"], "linewidth": 0.8} | weak
            axes.plot(b[fitted], level * b[fitted] ** exponent.value, **line)
        _with_intervals(axes, b, laws, quantity.name, (mapped, j), fitted, **style)
        label = f"{pressure_label(pressure)}: $x$ = {exponent.text()}"
        axes.plot([], [], **style | _hollow(fitted), ls="none", label=label)
    size_axis(axes, b, "sub-windows")
    values = laws[quantity.name].values[:, mapped]
    if (values > 0).any():
        logarithmic(axes, values)
    else:
        say_empty(axes, "no size holds ten nodes in contact", ticks=False)
    axes.set_ylabel(quantity.label)
    where = place(str(laws["direction"].values), float(laws["offset"][mapped]))
    letter(axes, quantity.letter, f"{quantity.words}, {where}")


def _hollow(fitted):
    """Face of the marker in a legend: white where no symbol drawn is filled."""
    return {} if fitted.any() else {"mfc": "white"}


def _with_intervals(axes, b, laws, name, index, fitted, **style):
    """Means over sub-windows and their 95 % intervals; hollow where not ``fitted``.

    ``index`` follows the dimension of b.
    """
    mean, low, high = along_size(laws, name, index)
    draw_bars(axes, b, mean, low, high, style["color"])
    draw_points(axes, b, mean, fitted, **style)


def _roughness_table(laws, shown):
    def rows(surface, offset, name, index):
        mean, low, high = along_size(laws, name, index)
        return pd.DataFrame(
            {
                "quantity": "sigma_z",
                "surface": surface,
                "offset_mm": offset,
                "b_mm": laws["scale_side"].values,
                "windows": laws["scale_n"].values,
                "fitted": laws["scale_used"].values,
                "mean_mm": mean,
                "low_mm": low,
                "high_mm": high,
            }
        )

    tables = [rows("face", np.nan, "face_sigma_z", ())]
    tables += [rows("composite", float(laws["offset"][i]), "sigma_z_all", (i,)) for i in shown]
    return pd.concat(tables, ignore_index=True)


def _contact_table(laws, quantity):
    name, law = quantity.name, quantity.exponent
    unit = "mm" if quantity is CLOSURE else "mm_per_MPa"
    tables = [
        pd.DataFrame(
            {
                "quantity": name,
                "offset_mm": float(laws["offset"][i]),
                "nominal_pressure_MPa": float(laws["nominal_pressure"][j]),
                "b_mm": laws["side"].values,
                "windows": laws["windows"].values,
                f"mean_{unit}": laws[name].values[:, i, j],
                f"low_{unit}": laws[f"{name}_low"].values[:, i, j],
                f"high_{unit}": laws[f"{name}_high"].values[:, i, j],
                **Estimate.read(laws, law)[i, j].columns("exponent"),
            }
        )
        for i in range(laws.sizes["offset"])
        for j in range(laws.sizes["normal_force"])
    ]
    return pd.concat(tables, ignore_index=True)


# -- caption ---------------------------------------------------------------------------------------


def _caption(laws):
    return (
        f"{opening('eq. 2 and section 5')} Roughness sigma_z, closure and compliance of "
        f"sub-windows against their side b. {_hurst_words(laws)}"
    )


def _hurst_words(laws):
    """H of the face, beside that expected of its dimension."""
    hurst, expected = (
        Estimate.read(laws, f"{of}_hurst", scale=EXPONENT) for of in ("face", "expected")
    )
    if not hurst.known:
        return "No fit of eq. 2: fewer than three sizes lie in its range."
    words = f"H = {hurst.text()}"
    if not expected.known:
        return f"{words}."
    agree = hurst.low <= expected.high and expected.low <= hurst.high
    verb = "agrees" if agree else "disagrees"
    return f"{words} {verb} with 3 - Delta_g = {expected.text()}."


def _closure_words(laws):
    """That no exponent of the closure could be fitted."""
    known = bool(np.isfinite(laws["closure_exponent"]).any())
    return "" if known else "No exponent: too few sizes hold ten nodes in contact."
