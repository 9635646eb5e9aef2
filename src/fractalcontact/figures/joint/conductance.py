"""Thermal or electrical conductance of the interface against pressure (Barber 2003)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import RESOLVED_NODES
from ...core.ranges import within
from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    finest_curves,
    heading,
    headline,
    legends_below,
    settings_of,
    spread,
)
from ..kit.empty import TOO_FULL, different_reasons, missing_lines, say_empty
from ..kit.points import draw_points
from ..kit.words import NOMINAL_PRESSURE, SUPPLEMENTARY, place, short

TITLE = "Thermal or electrical conductance of the interface against pressure"
SUBJECT = "specimen"
NEEDS = ("closure",)
ORDER = 80

CURVES = 5

#: Exponents that theories and experiments give: Persson's and Greenwood and Williamson's are 1,
#: Cooper, Mikic and Yovanovich (Int. J. Heat Mass Transf. 12 (1969) 279) and most tests 0.95.
#: Windows that hold few hills show lower ones (Pastewka et al., Phys. Rev. E 87 (2013) 062809).
THEORY = (0.95, 1.0)


def draw(atlas: DataTree, name: str) -> Drawing:
    """Conductance at about five offsets, at the finest resolution."""
    settings = settings_of(atlas, name)
    curves = finest_curves(atlas, name)
    direction = str(curves["direction"].values)
    e_star = settings["material"]["e_star"]
    table = _table(curves)

    figure = Figure(figsize=(WIDTH, 4.4))
    axes = figure.subplots()
    for n, (offset, points) in enumerate(table.groupby("offset_mm")):
        _draw_curve(axes, n, _state(direction, offset), points)
    axes.set_xscale("log")
    axes.set_yscale("log")
    _draw_theory(axes, table)
    axes.set_xlabel(f"{NOMINAL_PRESSURE} (MPa)")
    axes.set_ylabel("conductance over conductivity $h_c/k$ (mm$^{-1}$)")
    functions = (lambda y: y * e_star, lambda y: y / e_star)
    axes.secondary_yaxis("right", functions=functions).set_ylabel(
        r"interface stiffness $\mathrm{d}\sigma_0/\mathrm{d}w_\mathrm{int}$ (MPa/mm)"
    )
    n = table["offset_mm"].nunique()
    remarks = [*entries(axes)[n:], heading("lines: fits, exponents with 95 % intervals")]
    if not table["conductance_fitted"].all():
        remarks.append(heading(f"hollow: not fitted (fewer than {RESOLVED_NODES} nodes)"))
    if np.isfinite(table["conductance_per_mm"]).any():
        remarks += [heading(line) for line in missing_lines(table["stiffness_missing_because"])]
    legends_below(figure, entries(axes)[:n], remarks)
    headline(figure, settings["label"], place(direction))
    return Drawing(figure, table, _caption(table))


def _table(curves):
    """Points drawn, with the exponent fitted to their curve."""
    rows = []
    for i in spread(curves.sizes["offset"], CURVES):
        curve = curves.isel(offset=i)
        pressure = curve["nominal_pressure"].values
        low, high = (float(curve[f"conductance_pressure_{end}"]) for end in ("low", "high"))
        conductance, why = (
            curve[name].values for name in ("conductance", "interface_stiffness_reason")
        )
        inside = within(pressure, low, high) & curve["resolved"].values
        rows.append(
            pd.DataFrame(
                {
                    "offset_mm": float(curve["offset"]),
                    "nominal_pressure_MPa": pressure,
                    "conductance_per_mm": conductance,
                    "interface_stiffness_MPa_per_mm": curve["interface_stiffness"].values,
                    "stiffness_missing_because": why.astype(str),
                    "conductance_fitted": inside & np.isfinite(conductance),
                    **Estimate.read(curve, "conductance_exponent").columns("conductance_exponent"),
                }
            )
        )
    return pd.concat(rows, ignore_index=True)


def _state(direction, offset):
    return "against a plane" if direction == "none" else f"$v$ = {short(offset)} mm"


def _draw_curve(axes, n, state, points):
    law, fitted = points.iloc[0], points["conductance_fitted"]
    exponent = Estimate.read(law, "conductance_exponent", scale=EXPONENT).text()
    words = (
        f"exponent {exponent}"
        if np.isfinite(points["conductance_per_mm"]).any()
        else "no stiffness of the interface"
    )
    style = {"color": colour_of(n), "marker": MARKERS[n], "label": f"{state}: {words}"}
    x, y = points["nominal_pressure_MPa"], points["conductance_per_mm"]
    draw_points(axes, x, y, fitted, **style)
    if np.isfinite(law["conductance_exponent"]):
        # A least-squares line goes through the mean of its points.
        p, h = (
            np.log(points.loc[fitted, column])
            for column in ("nominal_pressure_MPa", "conductance_per_mm")
        )
        ends = np.array([p.min(), p.max()])
        line = np.exp(h.mean() + law["conductance_exponent"] * (ends - p.mean()))
        axes.plot(np.exp(ends), line, color=colour_of(n), lw=0.8)


def _draw_theory(axes, table):
    """The slopes of the theories, through the middle of the points fitted and behind them."""
    known = table[np.isfinite(table["conductance_per_mm"])]
    if known.empty:
        why = different_reasons(table["stiffness_missing_because"])
        say_empty(axes, "\n".join(why) or TOO_FULL)
        return
    middle = known[known["conductance_fitted"]] if known["conductance_fitted"].any() else known
    p, h = (np.log(middle[key]) for key in ("nominal_pressure_MPa", "conductance_per_mm"))
    ends = np.array([p.min(), p.mean(), p.max()])
    for slope, name in zip(
        THEORY,
        (f"theory: slopes {THEORY[0]:g} and {THEORY[1]:g} (at any height)", None),
        strict=True,
    ):
        height = np.exp(h.mean() + slope * (ends - p.mean()))
        axes.plot(np.exp(ends), height, color="0.5", lw=1.2, ls="--", zorder=0, label=name)


def _caption(table):
    return (
        f"{SUPPLEMENTARY} Conductance over conductivity, h_c/k, from the normal stiffness (Barber "
        f"2003). {_exponent_words(table)}"
    )


def _exponent_words(table):
    """The powers of the pressure, beside those of theory."""
    laws = table.drop_duplicates("offset_mm")
    fitted = laws[np.isfinite(laws["conductance_exponent"])]
    if fitted.empty:
        return "Too few pressures for an exponent."
    low, high = THEORY
    exponents = Estimate.read(fitted, "conductance_exponent", scale=EXPONENT)
    value = exponents.value
    reached = int(((exponents.low <= high) & (exponents.high >= low)).sum())
    below = int((exponents.high < low).sum())
    above = len(fitted) - reached - below
    values = (
        f"a power {exponents[0].text()}"
        if len(fitted) == 1
        else f"powers from {value.min():.3g} to {value.max():.3g}"
    )
    verdict = (
        f"as theory has it ({low:g} to {high:g})"
        if reached == len(fitted)
        else f"{reached} of {len(fitted)} intervals reach theory's {low:g} to {high:g} ({below} "
        f"below, {above} above)"
    )
    finite_size = " Windows of few hills have low powers." if below else ""
    return f"It grows as {values} of the pressure: {verdict}.{finite_size}"
