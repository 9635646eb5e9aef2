"""Closure curves with their hyperbolas, and real contact area against force (Figs. 4 and 5)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...surface.specimen import nominal_area
from ..kit.drawing import (
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    finest_curves,
    group,
    headline,
    legends_below,
    letter,
    settings_of,
    spread,
)
from ..kit.verdicts import claim, sentences
from ..kit.words import (
    estimate,
    force_label,
    force_unit,
    opening,
    percent,
    place,
    short,
)

TITLE = "Figs. 4 and 5: closure curves with their hyperbolas, and real contact area against force"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "area", "statements")
ORDER = 50

CURVES = 5

#: An exponent this near to 1 is what a plot shows as "nearly linear", the paper's words.
NEARLY = 0.1

#: An asymptote beyond this many times the largest closure is stated, not drawn.
FARTHEST_ASYMPTOTE = 1.5


def draw(atlas: DataTree, name: str) -> Drawing:
    """Closure and contact area at about five offsets, at the finest resolution."""
    label = settings_of(atlas, name)["label"]
    specimen = group(atlas, "specimens", name)
    curves = finest_curves(atlas, name)
    direction = str(curves["direction"].values)
    laws = group(atlas, "area", name).sel(direction=direction)
    drawn = spread(curves.sizes["offset"], CURVES)

    figure = Figure(figsize=(WIDTH, 4.2))
    left, right = figure.subplots(1, 2)
    _draw_closure(left, curves, drawn, direction, nominal_area(specimen))
    _draw_area(right, curves, drawn, direction, laws, nominal_area(specimen))
    legends_below(figure, entries(left), entries(right))
    letter(left, "a", "closure")
    letter(right, "b", "real contact area (hollow: not fitted)")
    headline(figure, label, place(direction))
    caption = sentences(
        _caption(label, direction, curves, drawn),
        claim(atlas, name, "hyperbola", "closure_is_hyperbolic"),
        claim(atlas, name, "A_r ~ F", "area_is_linear"),
        claim(atlas, name, "rise of compliance at first", "compliance_rises_at_first"),
    )
    return Drawing(figure, _table(curves, drawn, laws), caption)


def _hyperbola(curve, pressure):
    """w_int in mm of the fitted hyperbola sigma = k_ni w / (1 - w / w_m)."""
    k_ni, w_m = float(curve["hyperbola_k_ni"]), float(curve["hyperbola_w_m"])
    return pressure * w_m / (k_ni * w_m + pressure)


def _draw_closure(axes, curves, drawn, direction, area):
    unit, size = force_unit(curves["normal_force"].max())
    high = float(curves["nominal_pressure"][-1])
    pressure = np.linspace(0, high, 200)
    largest = float(curves["interface_closure"].isel(offset=drawn).max())
    limit = largest
    for n, i in enumerate(drawn):
        curve = curves.isel(offset=i)
        w_m = float(curve["hyperbola_w_m"])
        fit = (
            f"$w_m$ = {_asymptote(curve)}"
            if np.isfinite(w_m)
            else f"no fit: {curve['hyperbola_reason'].item()}"
        )
        style = {"color": colour_of(n)}
        axes.plot(
            curve["interface_closure"],
            curve["normal_force"] / size,
            MARKERS[n],
            label=f"{_state(direction, float(curve['offset']))}: {fit}",
            **style,
        )
        if not np.isfinite(w_m):
            continue
        axes.plot(_hyperbola(curve, pressure), pressure * area / size, lw=0.7, **style)
        if w_m <= FARTHEST_ASYMPTOTE * largest:
            axes.axvline(w_m, ls=":", lw=0.8, **style)
            limit = max(limit, w_m)
    axes.set_xlim(0, 1.05 * limit)
    axes.set_ylim(0, 1.05 * high * area / size)
    axes.set_xlabel(r"interface closure $w_\mathrm{int}$ (mm)")
    axes.set_ylabel(f"normal force $F$ ({unit})")
    second = _second_axis(axes, size / area)
    second.set_ylabel("nominal pressure $F/A_0$ (MPa)")


def _state(direction, offset):
    """One of the states of a legend."""
    return "against a plane" if direction == "none" else f"$v$ = {short(offset)} mm"


def _second_axis(axes, factor):
    """The left axis times a factor, at the right."""
    return axes.secondary_yaxis("right", functions=(lambda y: y * factor, lambda y: y / factor))


def _asymptote(curve):
    ends = (float(curve[f"hyperbola_w_m{end}"]) for end in ("", "_low", "_high"))
    return estimate(*ends, "mm")


def _draw_area(axes, curves, drawn, direction, laws, area):
    unit, size = force_unit(curves["normal_force"].max())
    force = curves["normal_force"].values
    for n, i in enumerate(drawn):
        law = laws.isel(offset=i)
        fitted = law["fitted"].values
        share = 100 * curves["area_share"].values[i]
        offset = float(curves["offset"][i])
        known = np.isfinite(float(law["exponent"]))
        exponent = f"exponent {_exponent(law)}" if known else f"no fit: {int(law['n'])} loads"
        style = {"color": colour_of(n), "ls": "none", "marker": MARKERS[n]}
        axes.plot(
            force[fitted] / size,
            share[fitted],
            label=f"{_state(direction, offset)}: {exponent}",
            **style,
        )
        axes.plot(force[~fitted] / size, share[~fitted], mfc="none", **style)
        if known:
            ends = np.array([float(law["force_low"]), float(law["force_high"])])
            line = 100 * float(law["unit_area"]) * ends ** float(law["exponent"]) / area
            axes.plot(ends / size, line, color=colour_of(n), lw=0.7, ls=LINES[n % 4])
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(f"normal force $F$ ({unit})")
    axes.set_ylabel("real contact area $A_r/A_0$ (%)")
    second = _second_axis(axes, area / 100)
    second.set_ylabel("$A_r$ (mm$^2$)")


def _exponent(law):
    return estimate(*(float(law[f"exponent{end}"]) for end in ("", "_low", "_high")))


def _table(curves, drawn, laws):
    """Points drawn, with the numbers fitted to their curve."""
    rows = []
    for i in drawn:
        curve, law = curves.isel(offset=i), laws.isel(offset=i)
        rows.append(
            pd.DataFrame(
                {
                    "offset_mm": float(curve["offset"]),
                    "force_N": curve["normal_force"].values,
                    "nominal_pressure_MPa": curve["nominal_pressure"].values,
                    "interface_closure_mm": curve["interface_closure"].values,
                    "area_mm2": curve["area"].values,
                    "area_share": curve["area_share"].values,
                    "w_m_mm": float(curve["hyperbola_w_m"]),
                    "w_m_low_mm": float(curve["hyperbola_w_m_low"]),
                    "w_m_high_mm": float(curve["hyperbola_w_m_high"]),
                    "area_corrected_mm2": curve["area_corrected"].values,
                    "area_fitted": law["fitted"].values,
                    "area_exponent": float(law["exponent"]),
                    "area_exponent_low": float(law["exponent_low"]),
                    "area_exponent_high": float(law["exponent_high"]),
                }
            )
        )
    return pd.concat(rows, ignore_index=True)


def _caption(label, direction, curves, drawn):
    first, last = (force_label(curves.attrs[f"hyperbola_force_{end}"]) for end in ("low", "high"))
    return (
        f"{opening('Figs. 4 and 5', label, place(direction))} (a) Closure, hyperbolas fitted from "
        f"{first} to {last}; (b) contact area, power laws. "
        f"{_hyperbola_words(curves.isel(offset=drawn))}."
    )


def _hyperbola_words(curves):
    """How well the hyperbolas of the paper fit."""
    fitted = np.isfinite(curves["hyperbola_w_m"].values)
    if not fitted.any():
        return f"No hyperbola could be fitted ({curves['hyperbola_reason'].values[0]})"
    largest = curves["interface_closure"].max("normal_force")
    beyond = int((largest > curves["hyperbola_w_m"]).values[fitted].sum())
    misfit = percent(curves["hyperbola_misfit"].max())
    return f"{beyond} of {fitted.sum()} curves pass their asymptote (rms misfit within {misfit})"
