"""Fig. 10: real contact area against resolution, and the nominal pressure it implies for size."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ..scaling import RESOLUTION
from ._domains import (
    Loading,
    disagreement,
    label_spacings,
    legend_below,
    number,
    opening,
    short,
    size_effect,
)
from .common import COLOURS, MARKERS, WIDTH, Drawing, force_label, force_of

#: Loads in panel (a).
_MOST_LOADS = 5

#: Sides b of panel (b), as multiples of the specimen's own: two decades.
_SIDES = np.array([0.1, 1.0, 10.0])


def draw(atlas, name):
    """A_r(s) with its power laws, and eq. 6 under the load of the maps.

    Parameters
    ----------
    atlas : xr.DataTree
    name : str
        The specimen.

    Returns
    -------
    Drawing
    """
    loading = Loading.of(atlas, name)
    i = loading.nearest_load(force_of(loading.settings["map_load"], loading.specimen))
    figure = Figure(figsize=(WIDTH, 3.9))
    left, right = figure.subplots(1, 2)
    area = _area_table(loading)
    _draw_areas(left, loading, i, area)
    pressure = _pressure_table(loading, i)
    _draw_pressures(right, loading, i, pressure)
    table = pd.concat([area, pressure], ignore_index=True)
    return Drawing(figure, table, _caption(loading, i, pressure))


def _area_table(loading):
    """One row a load and resolution; every load of the study, drawn or not."""
    scaling = loading.scaling.sortby(RESOLUTION)
    frame = scaling[["area", "sigma_n"]].to_dataframe().reset_index()
    spacing = scaling["spacing"].to_series()
    measure = scaling["hausdorff_measure"].to_series()
    delta = scaling["delta_sigma"].to_series()
    s = frame["resolution"].map(spacing)
    exponent = 2 - frame["load"].map(delta)
    return pd.DataFrame(
        {
            "panel": "a",
            "load_N": frame["load"],
            "spacing_mm": s,
            "area_mm2": frame["area"],
            "used": np.isfinite(frame["sigma_n"]),
            "fitted_area_mm2": frame["load"].map(measure) * s**exponent,
        }
    ).sort_values(["load_N", "spacing_mm"], ignore_index=True)


def _draw_areas(axes, loading, map_load, table):
    by_area = loading.estimates[0]
    for n, i in enumerate(loading.spread_loads(_MOST_LOADS, map_load)):
        force = loading.forces[i]
        rows = table[table["load_N"] == force]
        style = {"color": COLOURS[n], "marker": MARKERS[n], "linestyle": "none"}
        # Low loads may share their few nodes: the later marker lets the earlier one show.
        style["markersize"] = 7.5 - n
        label = f"{force_label(force)}: {by_area.entry(i)}"
        used = rows[rows["used"]]
        left_out = rows[~rows["used"]]
        axes.plot(used["spacing_mm"], used["area_mm2"], **style, label=label)
        axes.plot(left_out["spacing_mm"], left_out["area_mm2"], **style, markerfacecolor="white")
        axes.plot(used["spacing_mm"], used["fitted_area_mm2"], color=COLOURS[n])
    label_spacings(axes, loading.scaling["spacing"].sortby(RESOLUTION).values)
    axes.set_yscale("log")
    axes.set_ylabel("real contact area $A_r$ (mm$^2$)")
    axes.set_title("(a) contact area and resolution")
    legend_below(axes)


def _pressure_table(loading, i):
    """Eq. 6 by both estimators, and the specimen itself."""
    sides = loading.side * _SIDES
    parts = [
        pd.DataFrame(
            {
                "panel": "b",
                "load_N": loading.forces[i],
                "estimator": estimate.label,
                "b_mm": sides,
                "sigma_0_MPa": value,
                "sigma_0_low_MPa": np.fmin(low, high),
                "sigma_0_high_MPa": np.fmax(low, high),
            }
        )
        for estimate in loading.estimates
        for value, low, high in [size_effect(loading, estimate, i, sides)]
    ]
    own = {
        "panel": "b",
        "load_N": loading.forces[i],
        "estimator": "specimen",
        "b_mm": loading.side,
        "sigma_0_MPa": loading.forces[i] / loading.side**2,
    }
    return pd.concat([*parts, pd.DataFrame([own])], ignore_index=True)


def _draw_pressures(axes, loading, i, table):
    for estimate in loading.estimates:
        rows = table[table["estimator"] == estimate.label]
        style = {"color": estimate.style["color"], "linestyle": estimate.style["linestyle"]}
        label = f"{estimate.symbol}: {estimate.entry(i)}"
        axes.plot(rows["b_mm"], rows["sigma_0_MPa"], **style, label=label)
    own = table[table["estimator"] == "specimen"]
    axes.plot(own["b_mm"], own["sigma_0_MPa"], "*k", ms=9, label="specimen: $F/b^2$")
    axes.set(xscale="log", yscale="log")
    # The bands come last and do not widen the axes: some intervals span many decades.
    axes.set_ylim(axes.get_ylim())
    for estimate in loading.estimates:
        rows = table[table["estimator"] == estimate.label]
        ends = rows["sigma_0_low_MPa"], rows["sigma_0_high_MPa"]
        axes.fill_between(rows["b_mm"], *ends, color=estimate.style["color"], alpha=0.15, lw=0)
    axes.set_xlabel("side $b$ of the joint (mm)")
    axes.set_ylabel(r"nominal pressure $\sigma_0$ (MPa)")
    axes.set_title(f"(b) eq. 6 extrapolated, $F$ = {force_label(loading.forces[i])}")
    legend_below(axes)


def _caption(loading, i, pressure):
    by_area, by_box = loading.estimates
    force = force_label(loading.forces[i])
    return (
        f"{opening(10, loading)} (a) Real contact area at each resolution with the fitted "
        f"A_r ~ s^(2 - Delta_sigma), filled where used ({loading.fit_ranges(i)} at the load of "
        f"(b)). {_verdict(loading, i)} (b) Extrapolation by eq. 6 to other sides b for "
        f"F = {force}, Delta_sigma from A_r(s) (solid): {by_area.text(i)}, and from box counting "
        f"(dashed): {by_box.text(i)}, each with its own "
        f"sigma*; bands span the 95 % intervals. {disagreement(loading.scaling.isel(load=i))} "
        f"{_own_size(loading, pressure)}"
    )


def _verdict(loading, i):
    """Whether the area falls with refinement as a power law, in words."""
    by_area = loading.estimates[0]
    if by_area.reason[i]:
        return f"At that load there is {by_area.reason[i]}."
    r2 = number(loading.scaling["r2"].values[i], 3)
    if by_area.high[i] < 2:
        return f"As in the paper, A_r falls as s is refined, as a power law (r2 = {r2})."
    return (
        f"Unlike in the paper, a fall of A_r with refinement is not established (r2 = {r2}): the "
        "interval of Delta_sigma reaches 2."
    )


def _own_size(loading, pressure):
    """How far eq. 6 is from the specimen it was fitted to."""
    own = pressure[np.isclose(pressure["b_mm"], loading.side)].set_index("estimator")["sigma_0_MPa"]
    applied = own["specimen"]
    ratios = [
        f"{own[e.label] / applied:.2g} ({e.label})"
        for e in loading.estimates
        if np.isfinite(own[e.label])
    ]
    if not ratios:
        return f"The star is the specimen, b = {short(loading.side)} mm."
    return (
        f"Eq. 6 meets the specimen (star, b = {short(loading.side)} mm) only if "
        f"H_D = b^Delta_sigma; here it gives {' and '.join(ratios)} times the pressure applied."
    )
