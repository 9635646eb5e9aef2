"""Closure curves with their laws, real contact area and stiffness (Figs. 4 and 5)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import CORRECTED_NODES, RESOLVED_NODES
from ...core.verdicts import HYPERBOLA, SEMI_LOGARITHMIC
from ...core.window import nominal_area
from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    finest_curves,
    force_axis,
    group,
    heading,
    headline,
    label_short_span,
    legends_below,
    letter,
    settings_of,
    spread,
)
from ..kit.empty import TOO_FULL, say_empty
from ..kit.points import draw_points
from ..kit.verdicts import claim, sentences
from ..kit.words import NOMINAL_PRESSURE, opening, percent, place, short
from ._closure_words import all_offsets, laws_words, linear_words, no_law
from ._stiffness import draw_stiffness, missing_stiffness, stiffness_table, stiffness_words

TITLE = "Figs. 4 and 5: closure curves with their laws, real contact area, and stiffness"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "area", "statements")
ORDER = 50

CURVES = 5

#: What the numbers of every curve are.
_LEGEND = "(a), (b): rms misfit of logarithmic law, of hyperbola; $k_{ni}$ (MPa/mm) [95 %]"

#: One line for each law, whatever its curve and panel; beyond the loads fitted; of the area.
_OF_LAW = {SEMI_LOGARITHMIC: "-", HYPERBOLA: (0, (4, 2))}
_BEYOND, _OF_AREA = ":", "-."

#: Marker of states of too few nodes: open, and smaller than the others.
_OPEN = {"mfc": "none", "ms": 3, "mew": 0.6}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Closure and contact area at about five offsets, and stiffness over the spacing at one."""
    settings = settings_of(atlas, name)
    specimen = group(atlas, "specimens", name)
    curves = finest_curves(atlas, name)
    direction = str(curves["direction"].values)
    laws = group(atlas, "area", name).sel(direction=direction)
    drawn = spread(curves.sizes["offset"], CURVES)
    stiffness = stiffness_table(
        group(atlas, "closure", name).sel(direction=direction), settings, specimen
    )

    figure = Figure(figsize=(WIDTH, 7.2))
    panels = figure.subplot_mosaic("ab;cd", height_ratios=[1.1, 1])
    area = nominal_area(specimen)
    _draw_closure(panels["a"], curves, drawn, direction, area)
    _draw_light_loads(panels["b"], curves, drawn, area)
    _draw_area(panels["c"], curves, drawn, direction, laws, area)
    draw_stiffness(panels["d"], stiffness)
    area_line = [_line(_OF_AREA, "power law")] if _has_lines(panels["c"]) else []
    count = curves.sizes["offset"]
    of_laws, of_areas = all_offsets(curves, laws) if len(drawn) < count else ([], [])
    legends_below(
        figure,
        [*_keyed(_LEGEND, panels["a"], _line_entries(panels)), *of_laws],
        [
            *_keyed(r"(c): exponent $m$ of $A_r \sim F^m$ [95 %]", panels["c"], area_line),
            *_hollow_entries(panels),
            *of_areas,
            *(heading(line) for line in missing_stiffness(stiffness)),
        ],
    )
    some = f", {len(drawn)} of the {count} offsets drawn" if len(drawn) < count else ""
    letter(panels["a"], "a", f"closure{some}")
    letter(panels["b"], "b", f"light loads{_initial_words(curves)}")
    letter(panels["c"], "c", "contact area")
    letter(panels["d"], "d", f"stiffness over the spacing, {_state(direction, stiffness)}")
    headline(figure, settings["label"], place(direction))
    caption = sentences(
        _caption(curves, stiffness),
        claim(atlas, name, "closure_is_hyperbolic"),
        claim(atlas, name, "area_is_linear", why=linear_words(laws)),
    )
    table = [_table(curves, drawn, laws), stiffness.assign(panel="d")]
    return Drawing(figure, pd.concat(table, ignore_index=True), caption)


# -- closure ---------------------------------------------------------------------------------------


def _hyperbola(curve, pressure):
    """w_int in mm of the fitted hyperbola sigma_0 = k_ni w / (1 - w / w_m)."""
    k_ni, w_m = float(curve["hyperbola_k_ni"]), float(curve["hyperbola_w_m"])
    return pressure * w_m / (k_ni * w_m + pressure)


def _semi_logarithmic(curve, pressure):
    """w_int in mm of the fitted law w = a + b ln(sigma_0 / 1 MPa)."""
    a, b = (float(curve[f"semi_logarithmic_{name}"]) for name in "ab")
    return a + b * np.log(pressure)


def _draw_closure(axes, curves, drawn, direction, area):
    size = force_axis(axes.yaxis, curves["normal_force"])
    closures = curves["interface_closure"].isel(offset=drawn)
    limit = float(closures.max())
    for n, i in enumerate(drawn):
        curve = curves.isel(offset=i)
        style = {"color": colour_of(n)}
        force, resolved = curve["normal_force"].values / size, curve["resolved"].values
        w = curve["interface_closure"].values
        label = f"{_offset(direction, float(curve['offset']))}: {_law_words(curve)}"
        mark = {"marker": MARKERS[n], "label": label, **style}
        draw_points(axes, w, force, resolved, _OPEN, **mark)
        _draw_laws(axes, curve, area, size, style)
    if np.isfinite(closures).any():
        # Flush faces have closures of 0 alone.
        axes.set_xlim(0, 1.05 * limit if limit > 0 else None)
        if 0 < limit < 1e-3:  # long numbers would stand one over the other
            axes.ticklabel_format(axis="x", scilimits=(0, 0))
    else:
        say_empty(axes, TOO_FULL)
    axes.set_ylim(0, 1.05 * float(curves["normal_force"][-1]) / size)
    axes.set_xlabel(r"interface closure $w_\mathrm{int}$ (mm)")
    _second_axis(axes, size / area).set_ylabel(f"{NOMINAL_PRESSURE} (MPa)")


def _draw_light_loads(axes, curves, drawn, area):
    """The closure curves on logarithmic axes with their hyperbolas, down to k_ni at light load."""
    pressure = curves["nominal_pressure"].values
    for n, i in enumerate(drawn):
        curve = curves.isel(offset=i)
        style = {"color": colour_of(n)}
        w, resolved = curve["interface_closure"].values, curve["resolved"].values
        draw_points(axes, w, pressure, resolved, _OPEN, marker=MARKERS[n], **style)
        if np.isfinite(float(curve["hyperbola_k_ni"])):
            # Below the loads it is fitted to the hyperbola is all k_ni, and an extrapolation.
            first, last = (float(curve[f"closure_fit_{end}"]) / area for end in ("min", "max"))
            fitted = _OF_LAW[HYPERBOLA]
            for ends, line in (((first, last), fitted), ((pressure[0] / 2, first), _BEYOND)):
                along = np.geomspace(*ends, 40)
                axes.plot(_hyperbola(curve, along), along, ls=line, lw=0.8, **style)
    axes.set(xscale="log", yscale="log")
    closures = curves["interface_closure"].isel(offset=drawn)
    drawable = closures.where(closures > 0)
    if np.isfinite(drawable).any():
        axes.set_xlim(float(drawable.min()) / 1.5, float(drawable.max()) * 1.5)
        axes.set_ylim(pressure[0] / 1.5, pressure[-1] * 1.5)
    else:
        say_empty(axes, TOO_FULL)
    axes.set_xlabel(r"interface closure $w_\mathrm{int}$ (mm)")
    axes.set_ylabel(f"{NOMINAL_PRESSURE} (MPa)")
    label_short_span(axes.xaxis)


def _draw_laws(axes, curve, area, size, style):
    """Both laws over the loads that they were fitted to."""
    ends = [float(curve[f"closure_fit_{end}"]) / area for end in ("min", "max")]
    for law, of in ((HYPERBOLA, _hyperbola), (SEMI_LOGARITHMIC, _semi_logarithmic)):
        if np.isfinite(float(curve[f"{law.replace('-', '_')}_misfit"])):
            pressure = np.geomspace(*ends, 100)
            force = pressure * area / size
            axes.plot(of(curve, pressure), force, ls=_OF_LAW[law], lw=0.8, **style)


def _law_words(curve):
    """Misfits of both laws, and k_ni with its interval, as the legend's heading says."""
    misfits = [float(curve[f"{law}_misfit"]) for law in ("semi_logarithmic", "hyperbola")]
    if not np.isfinite(misfits).any():
        return f"no fit: {no_law(curve)}"
    known = (percent(misfit) if np.isfinite(misfit) else "no fit" for misfit in misfits)
    return f"{', '.join(known)}; {_initial_stiffness(curve)}"


def _initial_stiffness(curve):
    """k_ni with its interval, and the word where the atlas calls it undetermined."""
    k_ni = Estimate.read(curve, "hyperbola_k_ni", scale=EXPONENT)
    if k_ni.known and not curve["hyperbola_k_ni_determined"]:
        return k_ni.undetermined()
    return k_ni.text()


def _line(style, label):
    """Entry of a legend for a line of any curve."""
    return Line2D([], [], color="0.3", ls=style, lw=0.9, label=label)


def _has_lines(axes):
    """Whether more than markers is drawn."""
    return any(line.get_linestyle() != "None" for line in axes.lines)


def _keyed(head, axes, lines):
    """Entries of axes with a heading, and what their lines are; where none is fitted, no more."""
    return [heading(head), *entries(axes), *lines] if lines else entries(axes)


def _line_entries(panels):
    """What the lines of (a) and (b) are, of those that are drawn."""
    drawn = [line.get_linestyle() for which in "ab" for line in panels[which].lines]
    known = (
        ("-", _line(_OF_LAW[SEMI_LOGARITHMIC], "logarithmic law")),
        ("--", _line(_OF_LAW[HYPERBOLA], "hyperbola")),
        (":", _line(_BEYOND, "(b): hyperbola below the loads fitted, slope $k_{ni}$")),
    )
    return [entry for style, entry in known if style in drawn]


def _hollow_entries(panels):
    """What hollow markers are, if any is drawn."""
    lines = [line for panel in panels.values() for line in panel.lines]
    if not any(line.get_markerfacecolor() in ("none", "white") for line in lines):
        return []
    words = f"hollow: under {RESOLVED_NODES} nodes, in (c) {CORRECTED_NODES} (area raw)"
    return [Line2D([], [], color="0.3", ls="none", marker="o", label=words, **_OPEN)]


def _offset(direction, offset):
    """One of the states of a legend."""
    return "against a plane" if direction == "none" else f"$v$ = {short(offset)} mm"


def _state(direction, stiffness):
    return _offset(direction, stiffness["offset_mm"].iloc[0])


def _second_axis(axes, factor):
    """The left axis times a factor, at the right."""
    return axes.secondary_yaxis("right", functions=(lambda y: y * factor, lambda y: y / factor))


# -- area ------------------------------------------------------------------------------------------


def _draw_area(axes, curves, drawn, direction, laws, area):
    size = force_axis(axes.xaxis, curves["normal_force"])
    force = curves["normal_force"].values
    for n, i in enumerate(drawn):
        law, curve = laws.isel(offset=i), curves.isel(offset=i)
        enough = curve["area_corrected_resolved"].values
        known = np.isfinite(float(law["corrected_exponent"]))
        words = _exponent(law) if known else f"no fit: {law['corrected_n']:.0f} loads"
        share = np.where(enough, curve["area_corrected_share"], curve["area_share"])
        label = f"{_offset(direction, float(curve['offset']))}: {words}"
        style = {"color": colour_of(n), "marker": MARKERS[n], "label": label}
        draw_points(axes, force / size, 100 * share, enough, _OPEN, **style)
        if known:
            ends = np.array([float(law[f"corrected_force_{end}"]) for end in ("low", "high")])
            unit = float(law["corrected_unit_area"])
            line = 100 * unit * ends ** float(law["corrected_exponent"]) / area
            axes.plot(ends / size, line, color=colour_of(n), lw=0.8, ls=_OF_AREA)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylabel("real contact area $A_r/A_0$ (%)")
    _second_axis(axes, area / 100).set_ylabel("$A_r$ (mm$^2$)")


def _exponent(law):
    return Estimate.read(law, "corrected_exponent", scale=EXPONENT).text()


# -- table and caption -----------------------------------------------------------------------------


def _table(curves, drawn, laws):
    """Points drawn in (a) to (c), with the numbers fitted to their curve."""
    points = {
        "force_N": "normal_force",
        "nominal_pressure_MPa": "nominal_pressure",
        "nodes": "nodes",
        "resolved": "resolved",
        "interface_closure_mm": "interface_closure",
        "seated_closure_mm": "seated_closure",
        "separation_mm": "separation",
        "interface_stiffness_MPa_per_mm": "interface_stiffness",
        "stiffness_missing_because": "interface_stiffness_reason",
        "area_mm2": "area",
        "area_share": "area_share",
        "area_corrected_mm2": "area_corrected",
        "area_corrected_share": "area_corrected_share",
        "area_corrected_resolved": "area_corrected_resolved",
    }
    fitted = {
        "seating_pressure_MPa": "seating_pressure",
        "k_ni_MPa_per_mm": "hyperbola_k_ni",
        "k_ni_determined": "hyperbola_k_ni_determined",
        "k_ni_change": "hyperbola_k_ni_change",
        "w_m_mm": "hyperbola_w_m",
        "w_m_low_mm": "hyperbola_w_m_low",
        "w_m_high_mm": "hyperbola_w_m_high",
        "hyperbola_misfit": "hyperbola_misfit",
        "semi_logarithmic_a_mm": "semi_logarithmic_a",
        "semi_logarithmic_b_mm": "semi_logarithmic_b",
        "semi_logarithmic_misfit": "semi_logarithmic_misfit",
        "closure_law": "closure_law",
    }
    rows = []
    for i in drawn:
        curve, law = curves.isel(offset=i), laws.isel(offset=i)
        columns = {"panel": "a, b, c", "offset_mm": float(curve["offset"])}
        columns |= {column: curve[name].values for column, name in points.items()}
        columns |= {column: curve[name].item() for column, name in fitted.items()}
        columns["corrected_fitted"] = law["corrected_fitted"].values
        columns |= Estimate.read(law, "corrected_exponent").columns("corrected_exponent")
        rows.append(pd.DataFrame(columns))
    return pd.concat(rows, ignore_index=True)


def _caption(curves, stiffness):
    return (
        f"{opening('Figs. 4 and 5')} Closure, area, stiffness. "
        f"{laws_words(curves)} {stiffness_words(stiffness)}"
    )


def _initial_words(curves):
    """At how many offsets the curve itself is less stiff than its k_ni.

    A hyperbola stiffens with load: sigma_0 / w can nowhere be below its k_ni. Where it is, the
    curve is none, and k_ni an extrapolation that light loads do not follow.
    """
    k_ni = curves["hyperbola_k_ni"]
    fitted = int(np.isfinite(k_ni).sum())
    less = k_ni * curves["interface_closure"] > curves["nominal_pressure"]
    softer = int(less.any("normal_force").sum())
    return f": softer than $k_{{ni}}$ at {softer} of {fitted} offsets" if softer else ""
