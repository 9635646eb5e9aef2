"""Closure curves with their laws, real contact area and stiffness (Figs. 4 and 5)."""

from collections import Counter

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import CORRECTED_NODES, GOOD_FIT, RESOLVED_NODES
from ...core.subject import Subject
from ...core.text import number, percent
from .. import kit
from ._closure_laws import (
    LINES,
    OPEN,
    draw_closure,
    draw_light_loads,
    each_curve,
    no_law,
    offset_words,
)
from ._stiffness import draw_stiffness, over_spacing

TITLE = "Figs. 4 and 5: closure curves with their laws, real contact area, and stiffness"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "area", "statements")
ORDER = 50

CURVES = 5

#: Heads of the legend, which explain the numbers of each curve.
_LEGEND = (
    "(a), (b), from first touch: rms misfit of logarithmic law, of hyperbola; "
    "$k_{ni}$ (MPa/mm) [95 %]"
)
_LEGEND_AREA = r"(c): exponent $m$ of $A_r \sim F^m$ [95 %]"

_LEGEND_STIFFNESS = "(d): MPa/mm at the finest $s$ (change at $2s$)"
_HOLLOW = f"hollow: under {RESOLVED_NODES} nodes, in (c) {CORRECTED_NODES} (area raw)"

#: Variables of the curves in the table.
_COLUMNS = (
    *("nodes", "resolved", "interface_closure", "seated_closure", "separation"),
    *("interface_stiffness", "interface_stiffness_reason", "seating_pressure"),
    *("area", "area_share", "area_corrected", "area_corrected_share", "area_corrected_resolved"),
    *("hyperbola_k_ni", "hyperbola_k_ni_determined", "hyperbola_k_ni_change", "hyperbola_w_m"),
    *("hyperbola_misfit", "semi_logarithmic_a", "semi_logarithmic_b", "semi_logarithmic_misfit"),
    *("closure_law", "corrected_fitted", "corrected_exponent"),
)


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Closure and contact area at about five offsets, and stiffness over the spacing at one."""
    subject = Subject.of(atlas, name)
    laws = subject.curves("area")
    laws = laws[[one for one in laws.data_vars if str(one).startswith("corrected_")]]
    curves = subject.curves().assign(laws.data_vars)
    count = curves.sizes["offset"]
    drawn = curves.isel(offset=kit.spread(count, CURVES))
    stiffness = over_spacing(subject)

    figure = Figure(figsize=(kit.WIDTH, 7.6))
    panels = figure.subplot_mosaic("ab;cd", height_ratios=[1.1, 1])
    where = offset_words(subject, subject.offset)
    d = kit.Panel(panels["d"], "d", f"stiffness over the spacing, {where}")
    draw_closure(panels["a"], drawn, subject)
    draw_light_loads(panels["b"], drawn, subject)
    _draw_area(panels["c"], drawn, subject)
    missing = draw_stiffness(d, stiffness)
    some = f", {drawn.sizes['offset']} of the {count} offsets drawn" if count > CURVES else ""
    kit.letter(panels["a"], "a", f"closure{some}")
    kit.letter(panels["b"], "b", f"light loads{_softer(curves)}")
    kit.letter(panels["c"], "c", "contact area")
    of_laws = _keyed(_LEGEND, panels["a"], "semi_logarithmic", "hyperbola", "beyond")
    of_areas = _keyed(_LEGEND_AREA, panels["c"], "area")
    of_areas += [kit.heading(_LEGEND_STIFFNESS), *d.entries] if d.axes.has_data() else []
    of_areas += [kit.mark(color="0.3", ls="none", marker="o", label=_HOLLOW, **OPEN)]
    of_areas += [kit.heading(line) for line in missing]
    kit.legends_below(figure, of_laws, of_areas)
    kit.headline(figure, subject.label, kit.place(subject.direction))
    table = [kit.rows(drawn, *_COLUMNS, panel="a, b, c"), kit.table_of(d)]
    words = {
        "laws": Counter(filter(None, curves["closure_law"].values.tolist())),
        "no_law": no_law(curves.isel(offset=-1)),
        "limit": percent(GOOD_FIT),
        "state": subject.state("closure"),
        "hyperbola": kit.claim(atlas, name, "closure_is_hyperbolic", numbers=False),
        "linear": kit.claim(atlas, name, "area_is_linear"),
    }
    return kit.Drawing(figure, pd.concat(table, ignore_index=True), kit.caption(__name__, **words))


def _softer(curves):
    """Number of offsets, in words, at which the curve is less stiff than its k_ni."""
    fitted = int(np.isfinite(curves["hyperbola_k_ni"]).sum())
    softer = int(curves["softer_than_k_ni"].sum())
    return f": softer than $k_{{ni}}$ at {softer} of {fitted} offsets" if softer else ""


def _draw_area(axes, drawn, subject):
    """Real contact area with its power law; raw, and hollow, where it is not corrected."""
    size = kit.force_axis(axes.xaxis, drawn["normal_force"])
    force = drawn["normal_force"].values / size
    for curve, style in each_curve(drawn):
        enough = curve["area_corrected_resolved"].values
        exponent = Estimate.read(curve, "corrected_exponent", scale=EXPONENT)
        words = (
            exponent.text()
            if exponent.known
            else f"no fit: {number(curve['corrected_n'], 0)} loads"
        )
        share = 100 * np.where(enough, curve["area_corrected_share"], curve["area_share"])
        label = f"{offset_words(subject, float(curve['offset']))}: {words}"
        kit.draw_points(axes, force, share, enough, OPEN, label=label, **style)
        if exponent.known:
            ends = np.array([float(curve[f"corrected_force_{end}"]) for end in ("low", "high")])
            line = 100 * float(curve["corrected_unit_area"]) * ends**exponent.value / subject.area
            axes.plot(ends / size, line, color=style["color"], lw=0.8, ls=LINES["area"][0])
    axes.set(xscale="log", yscale="log", ylabel="real contact area $A_r/A_0$ (%)")
    kit.second_axis(axes, subject.area / 100, "$A_r$ (mm$^2$)")


def _keyed(head, axes, *lines):
    """Legend entries of axes under a heading, with those of the laws' lines."""
    style = {"color": "0.3", "lw": 0.9}
    named = [kit.mark(ls=LINES[line][0], label=LINES[line][1], **style) for line in lines]
    return [kit.heading(head), *kit.entries(axes), *named]
