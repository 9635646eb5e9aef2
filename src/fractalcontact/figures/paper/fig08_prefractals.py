"""Fig. 8: the contact domain at coarser and coarser resolution, and its real mean pressure."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from xarray import DataTree

from ...core.limits import CORRECTED_NODES
from ...core.validity import Validity
from ...core.verdicts import USUAL
from ...domain.renormalisation import RESOLUTION
from ..kit.domains import Loading, fall_reason
from ..kit.drawing import (
    COLOURS,
    WIDTH,
    Drawing,
    group,
    headline,
    label_short_span,
    letter,
)
from ..kit.maps import LEAST_DOT, draw_domain
from ..kit.verdicts import claim, sentences
from ..kit.words import (
    REAL_PRESSURE,
    force_label,
    number,
    opening,
    percent,
    short,
)

TITLE = "Fig. 8: contact domains of the pre-fractals under one load, and their mean pressure"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "area", "elastic_model", "statements")
ORDER = 130

#: Maps side by side, and the most times as wide as they are that all draw their nodes.
_COLUMNS, _WIDEST = 4, 3


def draw(atlas: DataTree, name: str) -> Drawing:
    """Contact domains at all resolutions, with A_r and sigma_n = F / A_r."""
    loading = Loading.of(atlas, name)
    i = loading.map_load
    table = _table(loading, i)
    laws = group(atlas, "area", name).sel(direction=loading.direction)
    slope = float(laws["rms_slope"].sel(offset=loading.offset, method="nearest"))
    models = group(atlas, "elastic_model", name).sel(direction=loading.direction)
    model = Validity.of(models.sel(offset=loading.offset, method="nearest").isel(normal_force=i))
    rows, columns = -(-len(table) // _COLUMNS), min(len(table), _COLUMNS)
    aspect = loading.sides[0] / loading.sides[1]
    height = rows * (WIDTH / _COLUMNS * aspect + 0.75)
    figure = Figure(figsize=(WIDTH, height + 2.3))
    top, bottom = figure.subfigures(2, 1, height_ratios=[height, 2.0])  # type: ignore[misc]  # an array
    panels = top.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    letters = "abcdefghijklmnop"
    times = _times(loading, columns)
    for axes, which, row in zip(panels, letters, table.itertuples(), strict=False):
        domain = loading.domain(row.resolution, i)
        draw_domain(axes, domain, loading.sides, ticks=4, times=times)
        letter(axes, which, f"$s$ = {short(row.spacing_mm)} mm\n{_area_words(row)}")
        axes.label_outer()
    for axes in panels[len(table) :]:
        axes.remove()
    axes = bottom.subplots()
    _draw_pressures(axes, table, model.limits)
    found = rf"$A_r \sim s^{{2-\Delta_\sigma}}$: {_exponent_words(loading.estimates[0], i)}"
    title = rf"$\sigma_n = F/A_r$; {found}; rms slope of the surface {short(slope)}"
    letter(axes, letters[len(table)], title)
    wide = "black: real contact area $A_r$ of the nominal $A_0$"
    wide += f"; nodes drawn {times} times as wide in all maps" if times > 1 else ""
    headline(figure, *loading.title, f"$F$ = {force_label(loading.forces[i])}", below=wide)
    why = fall_reason(loading.estimates[0], i)
    caption = sentences(
        f"{opening('Fig. 8')} Contact domains at F = {force_label(loading.forces[i])}.",
        model.sentence,
        claim(atlas, name, "area_is_lacunar", numbers=not why, why=why),
    )
    return Drawing(figure, table.assign(rms_slope=slope), caption)


def _table(loading, i):
    """One row a resolution, fine to coarse."""
    scaling = loading.scaling.isel(normal_force=i).sortby(RESOLUTION)
    area, corrected = scaling["area"].values, scaling["area_corrected"].values
    nodes, force = scaling["nodes"].values, loading.forces[i]
    enough = nodes >= CORRECTED_NODES
    return pd.DataFrame(
        {
            "load_N": force,
            "offset_mm": loading.offset,
            "resolution": scaling[RESOLUTION].values,
            "spacing_mm": scaling["spacing"].values,
            "nodes": nodes,
            "area_mm2": area,
            "area_share": area / np.prod(loading.sides),
            "area_corrected_mm2": np.where(enough, corrected, np.nan),
            "area_corrected_share": np.where(enough, corrected, np.nan) / np.prod(loading.sides),
            "sigma_n_MPa": scaling["sigma_n"].values,
            "sigma_n_raw_MPa": force / area,
        }
    )


def _times(loading, columns):
    """How many times as wide as they are all maps draw their nodes, so that print shows the finest.

    One number for all: with one for each, finer domains would look fuller than coarser ones.
    """
    nodes = max(loading.domain(loading.finest, 0).shape)
    points = 72 * 0.85 * WIDTH / columns / nodes
    return int(np.clip(np.ceil(LEAST_DOT / points), 1, _WIDEST))


def _exponent_words(by_area, i):
    """Delta_sigma of the areas with its interval, or that too few nodes touch for one."""
    if by_area.reason[i]:
        return f"no fit (fewer than {CORRECTED_NODES} nodes)"
    ends = (number(end[i]) for end in (by_area.value, by_area.low, by_area.high))
    doubt = "" if by_area.determined[i] else " (undetermined)"
    return r"$\Delta_\sigma$ = {} [{}, {}]".format(*ends) + doubt


def _area_words(row):
    """Area and pressure of a panel: corrected, or raw where too few nodes touch."""
    if np.isfinite(row.area_corrected_mm2):
        area, share, pressure = row.area_corrected_mm2, row.area_corrected_share, row.sigma_n_MPa
        raw = ""
    else:
        area, share, pressure = row.area_mm2, row.area_share, row.sigma_n_raw_MPa
        raw = " (raw)"
    return (
        f"$A_r$ = {short(area)} mm$^2${raw}\n$A_r/A_0$ = {percent(share)}\n"
        rf"$\sigma_n$ = {short(pressure)} MPa"
    )


def _draw_pressures(axes, table, limits):
    style = {"color": COLOURS[0], "marker": "o"}
    known = table.dropna(subset="sigma_n_MPa")
    if len(known):
        label = r"$A_r$ corrected for its edge"
        axes.plot(known["spacing_mm"], known["sigma_n_MPa"], **style, label=label)
    raw = {"mfc": "none", "ls": ":", "lw": 0.8}
    axes.plot(table["spacing_mm"], table["sigma_n_raw_MPa"], **style, **raw, label="$A_r$ raw")
    _draw_limit(axes, limits)
    axes.set(xscale="log", yscale="log")
    axes.set_xticks(table["spacing_mm"], [short(s) for s in table["spacing_mm"]])
    axes.xaxis.set_minor_locator(NullLocator())
    label_short_span(axes.yaxis)
    axes.set_xlabel("spacing $s$ (mm)")
    axes.set_ylabel(f"{REAL_PRESSURE} (MPa)")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), borderaxespad=0)


def _draw_limit(axes, limits):
    """The pressure that the material bears: what the study states, or that of usual materials."""
    low, high = limits.strength_low, limits.strength_high
    if limits.criterion != USUAL:
        label = f"{limits.criterion}: {short(low)} MPa"
        axes.axhline(low, color=COLOURS[2], ls="--", label=label)
        return
    label = f"{USUAL}:\n{short(low)} to {short(high)} MPa"
    axes.axhspan(low, high, color=COLOURS[2], alpha=0.2, lw=0, label=label)
