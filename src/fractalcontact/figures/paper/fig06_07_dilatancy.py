"""Rigid and elastic dilatancy, and the contact domains along the way (Figs. 6 and 7)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...core.estimate import Estimate
from ...core.limits import LEVEL_CHANGE, RESOLVED_NODES
from ...core.verdicts import FALLING, LEVEL, RISING
from ...core.window import window_sides
from ..kit.drawing import (
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    finest_curves,
    group,
    heading,
    headline,
    label_short_span,
    legends_below,
    letter,
    nearest_load,
    offset_axis,
    settings_of,
    spread,
)
from ..kit.maps import HALO, draw_domain
from ..kit.points import draw_points, hollow_entry
from ..kit.verdicts import claim, row_of, sentences
from ..kit.words import TOWARDS, area_label, force_label, opening, place, short

TITLE = "Figs. 6 and 7: rigid and elastic dilatancy, and contact domains along the curve"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "dilatancy", "closure", "contact", "statements")
ORDER = 100

DOMAINS, COLUMNS = 6, 3
#: What the table has of the contact area.
_OF_AREA = ("nodes", "area_share", "area_corrected_share", "area_corrected_resolved")
#: Of the fitted lines, points.
_FIT_WIDTH = 2.2
_WITHIN = f"{LEVEL_CHANGE:.0%}".replace("%", " %")

#: What the paper says of rock and of concrete, and the statements that judge it.
_PLATEAUS = ("dilatancy_flattens", "dilatancy_flattens_in_two")


def draw(atlas: DataTree, name: str) -> Drawing:
    """Dilatancy curves and contact domains at six offsets.

    Its data are the points of both kinds of curves and, for the map load, the contact areas.
    """
    settings = settings_of(atlas, name)
    specimen = group(atlas, "specimens", name)
    dilatancy = group(atlas, "dilatancy", name)
    curves = finest_curves(atlas, name)
    direction, finest = str(curves["direction"].values), int(curves["resolution"])
    loads = curves["normal_force"].values
    mapped = nearest_load(loads, settings["map_load"], specimen)
    asked = [nearest_load(loads, load, specimen) for load in settings["dilatancy_loads"]]
    shown = sorted({*asked, mapped})
    points = spread(curves.sizes["offset"], DOMAINS)
    plateaus = group(atlas, "joints", name)

    rows = -(-len(points) // COLUMNS)
    figure = Figure(figsize=(WIDTH, 3.2 + 2.5 * rows))
    top, bottom = figure.subfigures(2, 1, height_ratios=[3.2, 2.5 * rows])  # type: ignore[misc]  # an array
    rigid, elastic = top.subplots(1, 2)
    _draw_rigid(rigid, dilatancy, plateaus)
    opened = dilatancy["elastic_dilatancy"].sel(contact_direction=direction)
    opened = opened.assign_coords(resolved=curves["resolved"])
    _draw_elastic(elastic, dilatancy, opened, shown, mapped, points)
    legends_below(top, _keyed(rigid, dilatancy), entries(elastic))
    domains = group(atlas, "contact", name)[f"in_contact_{finest}"].sel(direction=direction)
    panels = bottom.subplots(rows, COLUMNS, squeeze=False)
    at_map = curves.isel(normal_force=mapped)
    larger = _draw_domains(panels, domains[:, mapped], at_map, points, window_sides(specimen))
    title = f"(c) contact domains at $F$ = {force_label(loads[mapped])}{_fall(atlas, name)}"
    title += "; nodes drawn enlarged" if larger else ""
    bottom.suptitle(title, x=0.01, ha="left", fontsize=8)
    headline(figure, settings["label"])
    table = _table(dilatancy, direction, shown, curves)
    caption = sentences(
        _caption(float(at_map["normal_force"])),
        sentences(*(claim(atlas, name, said) for said in _PLATEAUS)) or _plateau_words(plateaus),
        claim(atlas, name, "area_falls"),
    )
    return Drawing(figure, table, caption)


def _draw_rigid(axes, dilatancy, plateaus):
    v = dilatancy["rigid_offset"].values
    for n, direction in enumerate(dilatancy["direction"].values):
        opened = dilatancy["rigid_dilatancy"].sel(direction=direction)
        plateau = plateaus.sel(direction=direction)
        label = f"{TOWARDS.get(direction, 'plane')}: {_change_words(plateau)}"
        axes.plot(v, opened, label=label, **_direction_style(n))
        ends = np.array([float(plateau[f"plateau_offset_{end}"]) for end in ("min", "max")])
        if np.isfinite(ends).all():
            line = float(plateau["plateau_intercept"]) + float(plateau["plateau_slope"]) * ends
            axes.plot(ends, line, color=colour_of(n), lw=_FIT_WIDTH, alpha=0.7)
    axes.set_xlabel("offset $v$ (mm)")
    axes.set_ylabel(r"rigid dilatancy $\delta_r$ (mm)")
    axes.set_ylim(bottom=min(0, float(dilatancy["rigid_dilatancy"].min())))
    axes.set_xlim(left=0)
    letter(axes, "a", "rigid dilatancy")


def _direction_style(n):
    """Line of the n-th direction, in both panels."""
    return {"color": colour_of(n), "ls": LINES[n % 4], "lw": 0.9}


def _change_words(plateau):
    """Change of the fitted line in per cent of the mean, and what it is called."""
    change, low, high = Estimate.read(plateau, "plateau_change").ends
    if not np.isfinite(change):
        return "no fit"
    ends = f"{100 * low + 0.0:+.0f}, {100 * high + 0.0:+.0f}"
    return f"{100 * change:+.0f} % [{ends}], {plateau['plateau_trend'].item()}"


def _keyed(axes, dilatancy):
    """Legend of (a): what its numbers and its thick lines are, and the rule of a plateau."""
    half = short(float(dilatancy["rigid_offset"][-1]) / 2)
    return [
        heading(rf"change of fitted $\delta_r$ [95 %] in % of its mean, $v \geq$ {half} mm"),
        *entries(axes),
        Line2D(
            [],
            [],
            color="0.4",
            lw=_FIT_WIDTH,
            alpha=0.7,
            label=f"fitted lines; level: change within {_WITHIN}",
        ),
    ]


def _fall(atlas, name):
    """The exponent of A_r over the offset, where the statement on it gives one."""
    row = row_of(atlas, "statements", name, "area_falls")
    numbers = "" if row is None else str(row["numbers"].item())
    return rf"; all offsets: $A_r \sim v^x$, {numbers}" if numbers.startswith("x =") else ""


def _draw_elastic(axes, dilatancy, opened, shown, mapped, points):
    """Elastic dilatancy under some loads, below the rigid one."""
    direction, offsets = str(opened["contact_direction"].values), opened["offset"].values
    rigid = dilatancy["rigid_dilatancy"].sel(direction=direction)
    number = list(dilatancy["direction"].values).index(direction)
    style = _direction_style(number)
    axes.plot(dilatancy["rigid_offset"], rigid, label="rigid, $F$ = 0, as in (a)", **style)
    _elastic_curves(axes, opened, shown)
    _mark_points(axes, opened[:, mapped], points)
    offset_axis(axes, offsets)
    if axes.get_xscale() == "log":
        axes.set_xlim(offsets.min() / 1.3, offsets.max() * 1.3)
        label_short_span(axes.xaxis)
    axes.margins(y=0.12)
    low, high = axes.get_ylim()
    axes.set_ylim(low - 0.1 * (high - low), high)  # room for a letter below the lowest point
    axes.set_ylabel(r"dilatancy $\delta$ (mm)")
    letter(axes, "b", f"elastic dilatancy, {place(direction)}")


def _elastic_curves(axes, opened, shown):
    """Curves of the loads shown; states of too few nodes are hollow."""
    labelled = False
    for n, j in enumerate(shown):
        curve = opened[:, j]
        style = {"marker": MARKERS[n % len(MARKERS)], "color": colour_of(n + 4)}
        label = f"$F$ = {force_label(float(curve['normal_force']))}"
        resolved = curve["resolved"].values
        draw_points(axes, curve["offset"], curve, resolved, ls="-", label=label, **style)
        if not (labelled or resolved.all()):
            hollow_entry(axes, f"hollow: under {RESOLVED_NODES} nodes", **style)
            labelled = True


def _mark_points(axes, curve, points):
    """Letters of the domains at their points of the curve."""
    for k, i in enumerate(points):
        axes.annotate(
            _domain_letter(k),
            (float(curve["offset"][i]), float(curve[i])),
            (0, -11),
            textcoords="offset points",
            ha="center",
            path_effects=HALO,
        )


def _draw_domains(panels, domains, states, points, sides):
    """Contact domains of one load at some offsets, row by row; whether nodes are enlarged."""
    larger = False
    for k, panel in enumerate(panels.ravel()):
        if k >= len(points):
            panel.remove()
            continue
        i = points[k]
        larger |= draw_domain(panel, domains[i].values, sides)
        panel.set_title(
            f"{_domain_letter(k)}: $v$ = {short(states['offset'][i])} mm, "
            f"$A_r/A_0$ = {area_label(states.isel(offset=i))}"
        )
    return larger


def _domain_letter(k):
    return "ABCDEF"[k]


def _table(dilatancy, direction, shown, curves):
    """Points of (a), then of (b); contact area goes with the latter."""
    v = dilatancy["rigid_offset"].values
    rows = [
        pd.DataFrame(
            {
                "curve": "rigid",
                "direction": d,
                "force_N": 0.0,
                "offset_mm": v,
                "dilatancy_mm": dilatancy["rigid_dilatancy"].sel(direction=d).values,
            }
        )
        for d in dilatancy["direction"].values
    ]
    for j in shown:
        elastic = dilatancy["elastic_dilatancy"].sel(contact_direction=direction)[:, j]
        states = curves.isel(normal_force=j)
        columns = {
            "curve": "elastic",
            "direction": direction,
            "force_N": float(elastic["normal_force"]),
            "offset_mm": elastic["offset"].values,
            "dilatancy_mm": elastic.values,
        }
        columns |= {f"{name}_mm": states[name].values for name in ("separation", "bulk_settlement")}
        columns |= {name: states[name].values for name in _OF_AREA}
        rows.append(pd.DataFrame(columns))
    return pd.concat(rows, ignore_index=True)


def _caption(force):
    return (
        f"{opening('Figs. 6 and 7')} Rigid and elastic dilatancy, and contact domains at F = "
        f"{force_label(force)}."
    )


def _plateau_words(plateaus):
    """Which directions have a plateau over the second half of the offsets."""
    trends = plateaus["plateau_trend"].values.astype(str)
    fitted = int((trends != "").sum())
    if not fitted:
        return "Too few offsets to decide whether there is a plateau."
    words = f"{(trends == LEVEL).sum()} of {fitted} directions have a plateau"
    words += f" (changes within {_WITHIN})"
    for trend in (RISING, FALLING):
        named = [TOWARDS[str(d)] for d in plateaus["direction"].values[trends == trend]]
        words += f" ({trend}: {', '.join(named)})" if named else ""
    return f"{words}."
