"""Closure curves with their laws, real contact area and stiffness (Figs. 4 and 5)."""

from collections import Counter
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import CORRECTED_NODES, GOOD_FIT, RESOLVED_NODES
from ...core.subject import Subject
from ..kit.axes import force_axis, label_short_span
from ..kit.caption import caption
from ..kit.drawing import MARKERS, WIDTH, Drawing, colour_of, spread
from ..kit.empty import TOO_FULL, say_empty
from ..kit.legends import entries, heading, legends_below, mark
from ..kit.panel import Panel, rows, table_of
from ..kit.points import draw_points
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ..kit.words import NOMINAL_PRESSURE, percent, place, short
from ._stiffness import draw_stiffness, over_spacing

TITLE = "Figs. 4 and 5: closure curves with their laws, real contact area, and stiffness"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "area", "statements")
ORDER = 50

CURVES = 5

#: What the numbers of every curve are.
_LEGEND = "(a), (b): rms misfit of logarithmic law, of hyperbola; $k_{ni}$ (MPa/mm) [95 %]"
_LEGEND_AREA = r"(c): exponent $m$ of $A_r \sim F^m$ [95 %]"

#: One line for each law, whatever its curve and panel: style, words, what it is drawn from.
_LINES: dict[str, tuple[Any, str, str]] = {
    "semi_logarithmic": ("-", "logarithmic law", "semi_logarithmic_misfit"),
    "hyperbola": ((0, (4, 2)), "hyperbola", "hyperbola_misfit"),
    "beyond": (":", "(b): hyperbola below the loads fitted, slope $k_{ni}$", "hyperbola_k_ni"),
    "area": ("-.", "power law", "corrected_exponent"),
}
#: Marker of states of too few nodes: open, and smaller than the others.
_OPEN = {"mfc": "none", "ms": 3, "mew": 0.6}

#: What the table has of the curves, besides the law of the area.
_COLUMNS = (
    *("nodes", "resolved", "interface_closure", "seated_closure", "separation"),
    *("interface_stiffness", "interface_stiffness_reason", "seating_pressure"),
    *("area", "area_share", "area_corrected", "area_corrected_share", "area_corrected_resolved"),
    *("hyperbola_k_ni", "hyperbola_k_ni_determined", "hyperbola_k_ni_change", "hyperbola_w_m"),
    *("hyperbola_misfit", "semi_logarithmic_a", "semi_logarithmic_b", "semi_logarithmic_misfit"),
    *("closure_law", "corrected_fitted", "corrected_exponent"),
)


def draw(atlas: DataTree, name: str) -> Drawing:
    """Closure and contact area at about five offsets, and stiffness over the spacing at one."""
    subject = Subject.of(atlas, name)
    laws = subject.curves("area")
    laws = laws[[one for one in laws.data_vars if str(one).startswith("corrected_")]]
    curves = subject.curves().assign(laws.data_vars)
    count = curves.sizes["offset"]
    drawn = curves.isel(offset=spread(count, CURVES))
    stiffness = over_spacing(subject)

    figure = Figure(figsize=(WIDTH, 7.2))
    panels = figure.subplot_mosaic("ab;cd", height_ratios=[1.1, 1])
    where = _offset(subject, subject.offset)
    d = Panel(panels["d"], "d", f"stiffness over the spacing, {where}")
    _draw_closure(panels["a"], drawn, subject)
    _draw_light_loads(panels["b"], drawn, subject)
    _draw_area(panels["c"], drawn, subject)
    missing = draw_stiffness(d, stiffness)
    some = f", {drawn.sizes['offset']} of the {count} offsets drawn" if count > CURVES else ""
    letter(panels["a"], "a", f"closure{some}")
    letter(panels["b"], "b", f"light loads{_softer(curves)}")
    letter(panels["c"], "c", "contact area")
    of_laws = _keyed(_LEGEND, panels["a"], drawn, "semi_logarithmic", "hyperbola", "beyond")
    of_areas = _keyed(_LEGEND_AREA, panels["c"], drawn, "area")
    of_areas += [*_hollow(drawn, stiffness), *(heading(line) for line in missing)]
    legends_below(figure, of_laws, of_areas)
    headline(figure, subject.label, place(subject.direction))
    table = [rows(drawn, *_COLUMNS, panel="a, b, c"), table_of(d)]
    words = {
        "laws": Counter(filter(None, curves["closure_law"].values.tolist())),
        "no_law": _no_law(curves.isel(offset=-1)),
        "limit": percent(GOOD_FIT),
        "state": subject.state("closure"),
        "claims": [claim(atlas, name, one) for one in ("closure_is_hyperbolic", "area_is_linear")],
    }
    return Drawing(figure, pd.concat(table, ignore_index=True), caption(__name__, **words))


def _each(drawn):
    """Every curve that is drawn, with its colour and marker."""
    for n in range(drawn.sizes["offset"]):
        yield drawn.isel(offset=n), {"color": colour_of(n), "marker": MARKERS[n]}


def _known(data, name):
    return bool(np.isfinite(data[name]).any())


# -- closure ---------------------------------------------------------------------------------------


def _draw_closure(axes, drawn, subject):
    """Closure curves with both laws over the loads that they were fitted to."""
    size = force_axis(axes.yaxis, drawn["normal_force"])
    for curve, style in _each(drawn):
        label = f"{_offset(subject, curve['offset'])}: {_law_words(curve)}"
        points = curve["interface_closure"], curve["normal_force"] / size, curve["resolved"]
        draw_points(axes, *points, _OPEN, label=label, **style)
        _draw_laws(
            axes, curve, ("hyperbola", "semi_logarithmic"), subject.area, subject.area / size
        )
    if _known(drawn, "interface_closure"):
        # Flush faces have closures of 0 alone.
        limit = float(drawn["interface_closure"].max())
        axes.set_xlim(0, 1.05 * limit if limit > 0 else None)
        if 0 < limit < 1e-3:  # long numbers would stand one over the other
            axes.ticklabel_format(axis="x", scilimits=(0, 0))
    else:
        say_empty(axes, TOO_FULL)
    axes.set_ylim(0, 1.05 * float(drawn["normal_force"][-1]) / size)
    axes.set_xlabel(r"interface closure $w_\mathrm{int}$ (mm)")
    _second_axis(axes, size / subject.area).set_ylabel(f"{NOMINAL_PRESSURE} (MPa)")


def _draw_light_loads(axes, drawn, subject):
    """The closure curves on logarithmic axes with their hyperbolas, down to k_ni at light load."""
    pressure = drawn["nominal_pressure"].values
    for curve, style in _each(drawn):
        draw_points(axes, curve["interface_closure"], pressure, curve["resolved"], _OPEN, **style)
        _draw_laws(axes, curve, ("hyperbola", "beyond"), subject.area)
    axes.set(xscale="log", yscale="log")
    drawable = drawn["interface_closure"].where(drawn["interface_closure"] > 0)
    if np.isfinite(drawable).any():
        axes.set_xlim(float(drawable.min()) / 1.5, float(drawable.max()) * 1.5)
        axes.set_ylim(pressure[0] / 1.5, pressure[-1] * 1.5)
    else:
        say_empty(axes, TOO_FULL)
    axes.set_xlabel(r"interface closure $w_\mathrm{int}$ (mm)")
    axes.set_ylabel(f"{NOMINAL_PRESSURE} (MPa)")
    label_short_span(axes.xaxis)


def _draw_laws(axes, curve, lines, area, unit=1.0):
    """Fitted laws of the curve drawn last; its pressures times ``unit``.

    They go over the loads fitted; below these the hyperbola is all k_ni, and an extrapolation.
    """
    first, last = (float(curve[f"closure_fit_{end}"]) / area for end in ("min", "max"))
    lightest, colour = float(curve["nominal_pressure"][0]), axes.lines[-1].get_color()
    for line in lines:
        style, _, needed = _LINES[line]
        if _known(curve, needed):
            ends = (lightest / 2, first) if line == "beyond" else (first, last)
            pressure = np.geomspace(*ends, 100)
            closure = _closure_by(line, curve, pressure)
            axes.plot(closure, unit * pressure, ls=style, lw=0.8, color=colour)


def _closure_by(law, curve, pressure):
    """Closure w_int in mm by a fitted law.

    The hyperbola is sigma_0 = k_ni w / (1 - w / w_m), the other w = a + b ln(sigma_0 / 1 MPa).
    """
    if law != "semi_logarithmic":
        k_ni, w_m = (float(curve[f"hyperbola_{name}"]) for name in ("k_ni", "w_m"))
        return pressure * w_m / (k_ni * w_m + pressure)
    a, b = (float(curve[f"semi_logarithmic_{name}"]) for name in "ab")
    return a + b * np.log(pressure)


def _law_words(curve):
    """Misfits of both laws, and k_ni with its interval, as the legend's heading says."""
    misfits = [float(curve[f"{law}_misfit"]) for law in ("semi_logarithmic", "hyperbola")]
    if not np.isfinite(misfits).any():
        return f"no fit: {_no_law(curve)}"
    known = (percent(misfit) if np.isfinite(misfit) else "no fit" for misfit in misfits)
    k_ni = Estimate.read(curve, "hyperbola_k_ni", scale=EXPONENT)
    determined = bool(curve["hyperbola_k_ni_determined"]) or not k_ni.known
    return f"{', '.join(known)}; {k_ni.text() if determined else k_ni.undetermined()}"


def _no_law(curve):
    """Why no law could be fitted to a curve, without what would help."""
    return str(curve["closure_law_reason"].values).split(":")[0]


def _softer(curves):
    """At how many offsets the curve itself is less stiff than its k_ni."""
    fitted = int(np.isfinite(curves["hyperbola_k_ni"]).sum())
    softer = int(curves["softer_than_k_ni"].sum())
    return f": softer than $k_{{ni}}$ at {softer} of {fitted} offsets" if softer else ""


def _offset(subject, offset):
    """One of the states of a legend."""
    return "against a plane" if subject.direction == "none" else f"$v$ = {short(offset)} mm"


def _second_axis(axes, factor):
    """The left axis times a factor, at the right."""
    return axes.secondary_yaxis("right", functions=(lambda y: y * factor, lambda y: y / factor))


# -- area ------------------------------------------------------------------------------------------


def _draw_area(axes, drawn, subject):
    """Real contact area with its power law; raw, and hollow, where it is not corrected."""
    size = force_axis(axes.xaxis, drawn["normal_force"])
    force = drawn["normal_force"].values / size
    for curve, style in _each(drawn):
        enough = curve["area_corrected_resolved"].values
        exponent = Estimate.read(curve, "corrected_exponent", scale=EXPONENT)
        words = exponent.text() if exponent.known else f"no fit: {curve['corrected_n']:.0f} loads"
        share = 100 * np.where(enough, curve["area_corrected_share"], curve["area_share"])
        label = f"{_offset(subject, curve['offset'])}: {words}"
        draw_points(axes, force, share, enough, _OPEN, label=label, **style)
        if exponent.known:
            ends = np.array([float(curve[f"corrected_force_{end}"]) for end in ("low", "high")])
            line = 100 * float(curve["corrected_unit_area"]) * ends**exponent.value / subject.area
            axes.plot(ends / size, line, color=style["color"], lw=0.8, ls=_LINES["area"][0])
    axes.set(xscale="log", yscale="log", ylabel="real contact area $A_r/A_0$ (%)")
    _second_axis(axes, subject.area / 100).set_ylabel("$A_r$ (mm$^2$)")


# -- legends ---------------------------------------------------------------------------------------


def _keyed(head, axes, drawn, *lines):
    """Entries of axes with a heading, and what their lines are; where none is fitted, no more."""
    known = [_LINES[line] for line in lines if _known(drawn, _LINES[line][2])]
    style = {"color": "0.3", "lw": 0.9}
    named = [mark(ls=line, label=words, **style) for line, words, _ in known]
    return [heading(head), *entries(axes), *named] if named else entries(axes)


def _hollow(drawn, stiffness):
    """Entry of the legend for hollow markers, if any is drawn."""
    flags = drawn["resolved"], drawn["area_corrected_resolved"], stiffness["resolved"]
    if all(flag.all() for flag in flags):
        return []
    words = f"hollow: under {RESOLVED_NODES} nodes, in (c) {CORRECTED_NODES} (area raw)"
    return [mark(color="0.3", ls="none", marker="o", label=words, **_OPEN)]
