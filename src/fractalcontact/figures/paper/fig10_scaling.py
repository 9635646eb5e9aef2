"""Fig. 10: real contact area against resolution, and the nominal pressure it implies for size."""

import numpy as np
import pandas as pd
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from xarray import DataTree

from ...domain.renormalisation import RESOLUTION
from ..kit.domains import Loading, disagreement, fall_reason
from ..kit.drawing import (
    COLOURS,
    MARKERS,
    WEAK,
    WIDTH,
    Drawing,
    entries,
    headline,
    legends_below,
    letter,
)
from ..kit.verdicts import claim
from ..kit.words import force_label, opening, short
from ._size_effect import draw_axes, size_effect

TITLE = "Fig. 10: real contact area over resolution, and eq. 6"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "statements")
ORDER = 160
SECTION = "size effect"

#: Loads in panel (a).
_MOST_LOADS = 5
#: Colours of loads: none of those of the two estimates.
_LOAD_COLOURS = ("0.65", COLOURS[4], "0.4", COLOURS[3], COLOURS[0])


def draw(atlas: DataTree, name: str) -> Drawing:
    """A_r(s) with its power laws, and eq. 6 under the load of the maps."""
    loading = Loading.of(atlas, name)
    i = loading.map_load
    figure = Figure(figsize=(WIDTH, 3.9))
    left, right = figure.subplots(1, 2)
    area = _area_table(loading)
    _draw_areas(left, loading, i, area)
    pressure = size_effect(loading, i)
    _draw_pressures(right, loading, i, pressure)
    legends_below(figure, entries(left), entries(right))
    headline(figure, *loading.title)
    table = pd.concat([area, pressure.assign(panel="b")], ignore_index=True)
    why = fall_reason(loading.estimates[0], i)
    falls = claim(atlas, name, "area_is_lacunar", numbers=not why, why=why)
    return Drawing(figure, table, _caption(loading, i, falls))


def _area_table(loading):
    """One row a load and resolution; every load of the study, drawn or not."""
    scaling = loading.scaling.sortby(RESOLUTION)
    frame = scaling[["area", "area_corrected", "nodes", "area_used"]].to_dataframe().reset_index()
    spacing = scaling["spacing"].to_series()
    measure = scaling["hausdorff_measure"].to_series()
    delta = scaling["delta_sigma"].to_series()
    s = frame["resolution"].map(spacing)
    exponent = 2 - frame["normal_force"].map(delta)
    return pd.DataFrame(
        {
            "panel": "a",
            "load_N": frame["normal_force"],
            "spacing_mm": s,
            "nodes": frame["nodes"],
            "area_mm2": frame["area"],
            "area_corrected_mm2": frame["area_corrected"],
            "used": frame["area_used"],
            "fitted_area_mm2": frame["normal_force"].map(measure) * s**exponent,
        }
    ).sort_values(["load_N", "spacing_mm"], ignore_index=True)


def _draw_areas(axes, loading, map_load, table):
    by_area, thin = loading.estimates[0], False
    for n, i in enumerate(loading.spread_loads(_MOST_LOADS, map_load)):
        force = loading.forces[i]
        rows = table[table["load_N"] == force]
        style = {"color": _LOAD_COLOURS[n], "marker": MARKERS[n], "linestyle": "none"}
        # Low loads may share their few nodes: the later marker lets the earlier one show.
        style["markersize"] = 7.5 - n
        label = f"{force_label(force)}: {by_area.entry(i)}"
        used = rows[rows["used"]]
        raw = {"mfc": "none", "mew": 0.6, "markersize": 4}
        hollow = axes.plot(rows["spacing_mm"], rows["area_mm2"], **(style | raw))
        full = axes.plot(used["spacing_mm"], used["area_corrected_mm2"], **style)
        (hollow if used.empty else full)[0].set_label(label)
        weak = {} if by_area.determined[i] else WEAK
        thin |= bool(weak) and np.isfinite(used["fitted_area_mm2"]).any()
        colour = _LOAD_COLOURS[n]
        axes.plot(used["spacing_mm"], used["fitted_area_mm2"], color=colour, **weak)
    spacings = loading.scaling["spacing"].sortby(RESOLUTION).values
    axes.set(xscale="log", yscale="log")
    axes.set_xticks(spacings, [short(s) for s in spacings])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("spacing $s$ (mm)")
    axes.set_ylabel("real contact area $A_r$ (mm$^2$)")
    axes.plot(
        [], [], "o", color="0.3", ls="-", ms=4, label="filled: corrected for the edge, fitted"
    )
    axes.plot([], [], "o", color="0.3", mfc="none", mew=0.6, ms=4, label="hollow: raw, not fitted")
    if thin:
        label = r"thin line: $\Delta_\sigma$ undetermined"
        axes.plot([], [], color="0.3", label=label, **WEAK)
    letter(axes, "a", r"contact area, $A_r \sim s^{2-\Delta_\sigma}$ [95 %]")


def _draw_pressures(axes, loading, i, table):
    for estimate in loading.estimates:
        rows = table[table["estimator"] == estimate.label]
        style = {"color": estimate.style["color"], "linestyle": estimate.style["linestyle"]}
        if estimate.reason[i]:
            style["linestyle"] = "none"  # nothing is drawn: no line in the legend either
        style |= {} if estimate.determined[i] else WEAK
        label = f"{estimate.symbol}: {estimate.entry(i)}"
        axes.plot(rows["b_mm"], rows["sigma_0_MPa"], **style, label=label)
    own = table.iloc[0]
    point = own["specimen_b_mm"], own["specimen_sigma_0_MPa"]
    axes.plot(*point, "*k", ms=9, label=r"specimen: $\sigma_0 = F/A_0$")
    draw_axes(axes)
    # The bands come last and do not widen the axes: some intervals span many decades.
    axes.set_ylim(axes.get_ylim())
    for estimate in loading.estimates:
        rows = table[table["estimator"] == estimate.label]
        ends = rows["sigma_0_low_MPa"], rows["sigma_0_high_MPa"]
        colour, faint = estimate.style["color"], 0.2 if estimate.determined[i] else 0.1
        # The edges show whose band it is where both lie on each other.
        style = {"fc": to_rgba(colour, faint), "ec": to_rgba(colour, 0.5), "lw": 0.5}
        style["ls"] = estimate.style["linestyle"]
        if np.isfinite(ends).any():
            axes.fill_between([], [], label=f"95 %, {estimate.symbol}", **style)
            # Lines are cut to the axes before they are dashed, edges of areas after: the dashes of
            # one that ends a thousand decades below would never be done.
            axes.fill_between(rows["b_mm"], *ends, fc=style["fc"], lw=0)
            for end in ends:
                axes.plot(rows["b_mm"], end, color=style["ec"], lw=0.5, ls=style["ls"])
    letter(axes, "b", f"eq. 6 extrapolated, $F$ = {force_label(loading.forces[i])}")


def _caption(loading, i, falls):
    by_area, by_box = loading.estimates
    return (
        f"{opening('Fig. 10')} A_r(s), and eq. 6 extrapolated from the specimen at F = "
        f"{force_label(loading.forces[i])}. {falls} Delta_sigma is {by_area.at(i)} by A_r(s)"
        f"{_determined_words(loading, i)}, {by_box.at(i)} by box counting. "
        f"{disagreement(loading.scaling.isel(normal_force=i))}"
    )


def _determined_words(loading, i):
    """Where the load of the maps determines none: the nearest load drawn that does."""
    by_area = loading.estimates[0]
    drawn = loading.spread_loads(_MOST_LOADS, i)
    known = [j for j in drawn if by_area.determined[j] and not by_area.reason[j]]
    if by_area.determined[i] or by_area.reason[i] or not known:
        return ""
    nearest = min(known, key=lambda j: abs(j - i))
    return f" but {by_area.at(nearest)} at {force_label(loading.forces[nearest])}"
