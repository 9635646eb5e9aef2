"""Fig. 8: the contact domain at coarser and coarser resolution, and its real mean pressure."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from xarray import DataTree

from ...core.resolved import CORRECTED_NODES
from ...domain.renormalisation import RESOLUTION
from ...mechanics.model_validity import elastic_model_validity
from ..kit.domains import Loading, disagreement
from ..kit.drawing import (
    COLOURS,
    WIDTH,
    Drawing,
    group,
    headline,
    label_short_span,
    letter,
)
from ..kit.maps import ENLARGED, draw_domain
from ..kit.verdicts import claim, sentences
from ..kit.words import (
    REAL_PRESSURE,
    force_label,
    opening,
    percent,
    pressure_label,
    short,
)

TITLE = "Fig. 8: contact domains of the pre-fractals under one load, and their mean pressure"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "area", "statements")
ORDER = 130

#: Maps side by side.
_COLUMNS = 4


def draw(atlas: DataTree, name: str) -> Drawing:
    """Contact domains at all resolutions, with A_r and sigma_n = F / A_r."""
    loading = Loading.of(atlas, name)
    i = loading.map_load
    table = _table(loading, i)
    laws = group(atlas, "area", name).sel(direction=loading.direction)
    slope = float(laws["rms_slope"].sel(offset=loading.offset, method="nearest"))
    limit = _limit(loading.settings["material"])
    rows, columns = -(-len(table) // _COLUMNS), min(len(table), _COLUMNS)
    aspect = loading.sides[0] / loading.sides[1]
    height = rows * (WIDTH / _COLUMNS * aspect + 0.75)
    figure = Figure(figsize=(WIDTH, height + 2.3))
    top, bottom = figure.subfigures(2, 1, height_ratios=[height, 2.0])  # type: ignore[misc]  # an array
    panels = top.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    letters = "abcdefghijklmnop"
    larger = False
    for axes, which, row in zip(panels, letters, table.itertuples(), strict=False):
        larger |= draw_domain(axes, loading.domain(row.resolution, i), loading.sides)
        letter(axes, which, f"$s$ = {short(row.spacing_mm)} mm\n{_area_words(row)}")
        axes.label_outer()
    for axes in panels[len(table) :]:
        axes.remove()
    axes = bottom.subplots()
    _draw_pressures(axes, table, limit)
    letter(axes, letters[len(table)], f"real mean pressure (rms slope {short(slope)})")
    headline(figure, *loading.title, f"$F$ = {force_label(loading.forces[i])}")
    falls = claim(atlas, name, "fall of A_r as a power", "area_is_lacunar", numbers=False)
    caption = _caption(loading, i, table, slope, falls)
    caption = sentences(caption, ENLARGED if larger else "")
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
            "sigma_n_MPa": force / np.where(enough, corrected, np.nan),
            "sigma_n_raw_MPa": force / area,
        }
    )


def _area_words(row):
    """Area and pressure of a panel: corrected, or raw where too few nodes touch."""
    if np.isfinite(row.area_corrected_mm2):
        area, share, pressure = row.area_corrected_mm2, row.area_corrected_share, row.sigma_n_MPa
        raw = f" (raw {short(row.area_mm2)})"
    else:
        area, share, pressure = row.area_mm2, row.area_share, row.sigma_n_raw_MPa
        raw = " (raw)"
    return (
        f"$A_r$ = {short(area)} mm$^2${raw}\n$A_r/A_0$ = {percent(share)}\n"
        rf"$\sigma_n$ = {pressure_label(pressure)}"
    )


def _limit(material):
    """The pressure that the material bears and its name, of what the study states; or None."""
    for key, words in (("hardness", "hardness"), ("joint_wall_strength", "joint wall strength")):
        if np.isfinite(material[key]):
            return float(material[key]), words
    return None


def _draw_pressures(axes, table, limit):
    style = {"color": COLOURS[0], "marker": "o"}
    known = table.dropna(subset="sigma_n_MPa")
    axes.plot(known["spacing_mm"], known["sigma_n_MPa"], **style, label="corrected area")
    raw = {"mfc": "none", "ls": ":", "lw": 0.8}
    axes.plot(table["spacing_mm"], table["sigma_n_raw_MPa"], **style, **raw, label="raw area")
    if limit is not None:
        pressure, words = limit
        axes.axhline(pressure, color=COLOURS[2], ls="--", label=f"{words} of the study")
    axes.set(xscale="log", yscale="log")
    axes.set_xticks(table["spacing_mm"], [short(s) for s in table["spacing_mm"]])
    axes.xaxis.set_minor_locator(NullLocator())
    label_short_span(axes.yaxis)
    axes.set_xlabel("spacing $s$ (mm)")
    axes.set_ylabel(f"{REAL_PRESSURE} (MPa)")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), borderaxespad=0)


def _caption(loading, i, table, slope, falls):
    # "no fit", "no dimension": the reasons stand in Figs. 9 and 10.
    by_area, by_box = (e.reason[i].split(":")[0] or e.text(i) for e in loading.estimates)
    return (
        f"{opening('Fig. 8')} Contact domains at F = {force_label(loading.forces[i])}. "
        f"{_model_words(loading, table, slope)} {falls} Delta_sigma: {by_area} by A_r(s), "
        f"{by_box} by box counting. {disagreement(loading.scaling.isel(normal_force=i))}"
    )


def _model_words(loading, table, slope):
    """Whether pressures and slopes are beyond what the model of elastic half-spaces can bear."""
    finest = table.iloc[0]
    pressure = finest["sigma_n_MPa"]
    if not np.isfinite(pressure):
        pressure = finest["sigma_n_raw_MPa"]
    return elastic_model_validity(pressure, slope, loading.settings["material"]).sentence
