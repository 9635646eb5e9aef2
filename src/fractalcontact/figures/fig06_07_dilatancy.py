"""Rigid and elastic dilatancy, and the contact domains along the way (Figs. 6 and 7)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ..fitting import fit_line
from ..sweep import window_sides
from ._domains import draw_domain
from ._mechanics import PAPER, TOWARDS, colour_of, letter, place, slope_text, spread
from .common import (
    COLOURS,
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    force_label,
    force_of,
    group,
    settings_of,
)

DOMAINS = 6
#: The main axes of (b) show the first offsets, this part of the largest, and at least so many.
INITIAL_PART, INITIAL_OFFSETS = 0.1, 4
#: A change over the second half below this share of the mean there is called nearly flat.
NEARLY_FLAT = 0.1


def draw(atlas, name):
    """Dilatancy curves and contact domains at six offsets.

    Parameters
    ----------
    atlas : xr.DataTree
    name : str
        A specimen of the atlas.

    Returns
    -------
    Drawing
        Its data are the points of both kinds of curves and, for the map load, the contact areas.
    """
    settings = settings_of(atlas, name)
    specimen = group(atlas, "specimens", name)
    dilatancy = group(atlas, "dilatancy", name)
    closure = group(atlas, "closure", name)
    direction = settings["contact_directions"][0]
    finest = int(closure["resolution"].min())
    share = closure["area_share"].sel(direction=direction, resolution=finest)
    loads = closure["load"].values
    mapped = _nearest(loads, force_of(settings["map_load"], specimen))
    asked = [_nearest(loads, force_of(load, specimen)) for load in settings["dilatancy_loads"]]
    shown = sorted({*asked, mapped})
    points = spread(closure.sizes["offset"], DOMAINS)
    plateaus = {str(d): _plateau(dilatancy, d) for d in dilatancy["direction"].values}

    columns = min(3, len(points))
    rows = -(-len(points) // columns)
    figure = Figure(figsize=(WIDTH, 3.2 + 2.3 * rows))
    top, bottom = figure.subfigures(2, 1, height_ratios=[3.2, 2.3 * rows])
    rigid, elastic = top.subplots(1, 2)
    _draw_rigid(rigid, dilatancy, plateaus)
    _draw_elastic(elastic, dilatancy, direction, shown, mapped, points)
    domains = group(atlas, "contact", name)[f"in_contact_{finest}"].sel(direction=direction)
    panels = np.atleast_1d(bottom.subplots(rows, columns)).ravel()
    for k, (panel, i) in enumerate(zip(panels, points, strict=False)):
        draw_domain(panel, domains.isel(offset=i, load=mapped).values, window_sides(specimen))
        panel.set_xlabel("$x$ (mm)")
        panel.set_ylabel("$y$ (mm)")
        percent = 100 * float(share[i, mapped])
        panel.set_title(
            f"{chr(65 + k)}: $v$ = {float(share['offset'][i]):.3g} mm, $A_r/A_0$ = {percent:.2g} %"
        )
    for panel in panels[len(points) :]:
        panel.set_visible(False)
    letter(rigid, "a", "rigid dilatancy")
    letter(elastic, "b", f"elastic dilatancy, {place(direction)}")
    bottom.suptitle(f"(c) contact domains at $F$ = {force_label(loads[mapped])}", x=0.01, ha="left")
    figure.suptitle(settings["label"])
    table = _table(dilatancy, direction, shown, share)
    caption = _caption(settings["label"], direction, loads[mapped], share[:, mapped], plateaus)
    return Drawing(figure, table, caption)


def _nearest(loads, force):
    return int(np.argmin(np.abs(loads - force)))


def _plateau(dilatancy, direction):
    """Line of delta_r over the second half of the offsets, and its change over its mean there."""
    v = dilatancy["rigid_offset"].values
    second = v >= v[-1] / 2
    opened = dilatancy["rigid_dilatancy"].sel(direction=direction).values[second]
    line = fit_line(v[second], opened)
    return line, line.slope * (line.x_max - line.x_min) / opened.mean()


def _draw_rigid(axes, dilatancy, plateaus):
    v = dilatancy["rigid_offset"].values
    for n, (direction, (line, _)) in enumerate(plateaus.items()):
        opened = dilatancy["rigid_dilatancy"].sel(direction=direction)
        slope = f"slope {slope_text(line)}" if np.isfinite(line.slope) else "no fit"
        name = TOWARDS.get(direction, "plane")
        axes.plot(v, opened, color=colour_of(n), ls=LINES[n % 4], label=f"{name}: {slope}")
        if np.isfinite(line.slope):
            ends = np.array([line.x_min, line.x_max])
            axes.plot(ends, line.intercept + line.slope * ends, color=colour_of(n), lw=0.6)
    axes.set_xlabel("offset $v$ (mm)")
    axes.set_ylabel(r"rigid dilatancy $\delta_r$ (mm)")
    axes.set_ylim(bottom=min(0, float(dilatancy["rigid_dilatancy"].min())))
    axes.set_xlim(left=0)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2))


def _draw_elastic(axes, dilatancy, direction, shown, mapped, points):
    offsets = dilatancy["offset"].values
    limit = max(INITIAL_PART * offsets[-1], offsets[min(INITIAL_OFFSETS, len(offsets)) - 1])
    elastic = dilatancy["elastic_dilatancy"].sel(contact_direction=direction)
    _elastic_curves(axes, dilatancy, direction, elastic, shown)
    _mark_points(axes, offsets, elastic[:, mapped].values, points, limit)
    axes.set_xlim(0, 1.05 * limit)
    axes.set_xlabel("offset $v$ (mm)")
    axes.set_ylabel(r"dilatancy $\delta$ (mm)")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
    if limit >= offsets[-1]:
        return
    inset = axes.inset_axes([0.62, 0.08, 0.36, 0.36])
    _elastic_curves(inset, dilatancy, direction, elastic, shown, ms=2, lw=0.7)
    _mark_points(inset, offsets, elastic[:, mapped].values, points, np.inf)
    inset.tick_params(labelsize=6)


def _elastic_curves(axes, dilatancy, direction, elastic, shown, **style):
    rigid = dilatancy["rigid_dilatancy"].sel(direction=direction)
    axes.plot(dilatancy["rigid_offset"], rigid, color="0.6", lw=style.get("lw", 1), label="rigid")
    for n, j in enumerate(shown):
        axes.plot(
            elastic["offset"],
            elastic[:, j],
            marker=MARKERS[n],
            color=colour_of(n + 1),
            label=f"$F$ = {force_label(float(elastic['load'][j]))}",
            **style,
        )


def _mark_points(axes, offsets, values, points, limit):
    for k, i in enumerate(points):
        if offsets[i] <= limit:
            axes.annotate(
                chr(65 + k),
                (offsets[i], values[i]),
                (0, -9),
                fontsize=7,
                ha="center",
                textcoords="offset points",
                color=COLOURS[0],
            )


def _table(dilatancy, direction, shown, share):
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
        rows.append(
            pd.DataFrame(
                {
                    "curve": "elastic",
                    "direction": direction,
                    "force_N": float(elastic["load"]),
                    "offset_mm": elastic["offset"].values,
                    "dilatancy_mm": elastic.values,
                    "area_share": share[:, j].values,
                }
            )
        )
    return pd.concat(rows, ignore_index=True)


def _caption(label, direction, force, share, plateaus):
    return (
        f"After Figs. 6 and 7 of {PAPER}: {label}. (a) Rigid dilatancy, with straight lines over "
        f"the second half of the offsets. (b) Elastic dilatancy, {place(direction)}; letters stand "
        f"at F = {force_label(force)}. (c) Contact domains there. {_plateau_words(plateaus)} "
        f"{_area_words(share, force)}"
    )


def _plateau_words(plateaus):
    parts = []
    for direction, (line, change) in plateaus.items():
        if not np.isfinite(line.slope):
            parts.append(f"{TOWARDS.get(direction, direction)}: too few offsets to tell")
            continue
        if line.slope_low <= 0 <= line.slope_high:
            verdict = "flat within its interval"
        elif abs(change) <= NEARLY_FLAT:
            verdict = "nearly flat"
        else:
            verdict = "still rising" if change > 0 else "falling"
        parts.append(
            f"{TOWARDS[direction]} {slope_text(line)} ({100 * change:+.2g} % of the mean: {verdict})"
        )
    return (
        "Slopes there in mm/mm, with 95 % intervals that take neighbouring offsets as independent "
        f"(they are not, so the intervals are too narrow): {'; '.join(parts)}. The paper's rock "
        "reaches a plateau in all directions, its concrete in two of four."
    )


def _area_words(share, force):
    slid = share["offset"].values > 0
    area = share.values[slid]
    line = fit_line(np.log(share["offset"].values[slid]), np.log(area))
    if not np.isfinite(line.slope):
        return "Too few offsets to tell whether the contact area falls with v."
    verdict = (
        "it falls, as in the paper"
        if line.slope_high < 0
        else "it rises, unlike the paper's"
        if line.slope_low > 0
        else "no trend beyond the interval, where the paper has it fall"
    )
    return (
        f"At F = {force_label(force)} A_r goes as v to the power {slope_text(line)} over "
        f"{line.n} offsets from {100 * area[0]:.2g} to {100 * area[-1]:.2g} %: {verdict}."
    )
