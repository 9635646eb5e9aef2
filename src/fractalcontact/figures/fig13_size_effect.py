"""Fig. 13: what eq. 6 makes of the size of the joint, for growing load."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ._domains import (
    Loading,
    disagreement,
    fractal_pressure,
    interval,
    opening,
    short,
    size_effect,
    trend,
)
from .common import COLOURS, MARKERS, WIDTH, Drawing, force_label

#: Loads drawn.
_MOST_LOADS = 6

#: Sides b, as multiples of the specimen's own: two decades.
_SIDES = np.array([0.1, 1.0, 10.0])


def draw(atlas, name):
    """Eq. 6 under several loads, by both estimators.

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
    shown = loading.spread_loads(_MOST_LOADS)
    table = _table(loading, shown)
    figure = Figure(figsize=(WIDTH, 3.9))
    axes, beside = figure.subplots(1, 2, width_ratios=[1.5, 1])
    beside.set_axis_off()
    handles = []
    for n, i in enumerate(shown):
        under_load = table[table["load_N"] == loading.forces[i]]
        for estimate in loading.estimates:
            rows = under_load[under_load["estimator"] == estimate.label]
            style = {"color": COLOURS[n], "linestyle": estimate.style["linestyle"]}
            axes.loglog(rows["b_mm"], rows["sigma_0_MPa"], **style)
            style["marker"] = MARKERS[n] if estimate.key == "area" else None
            handles.append(Line2D([], [], **style, label=_entry(loading, estimate, i)))
        own = (loading.side, loading.forces[i] / loading.side**2)
        axes.loglog(*own, MARKERS[n], color=COLOURS[n], mec="white", mew=0.5, ms=7, zorder=3)
    axes.set_xlabel("side $b$ of the joint (mm)")
    axes.set_ylabel(r"nominal pressure $\sigma_0$ (MPa)")
    axes.set_title("eq. 6 extrapolated to other sizes; markers: the specimen")
    beside.legend(
        handles=handles,
        loc="center left",
        bbox_to_anchor=(0, 0.5),
        borderaxespad=0,
        title=r"slope $-(2-\Delta_\sigma)$, 95 % interval",
        title_fontsize=7,
        alignment="left",
    )
    return Drawing(figure, table, _caption(loading))


def _slope(estimate):
    """-(2 - Delta_sigma) and its interval, each (n_load,)."""
    return estimate.value - 2, estimate.low - 2, estimate.high - 2


def _entry(loading, estimate, i):
    """Legend of one line."""
    if estimate.reason[i]:
        return f"{force_label(loading.forces[i])}, {estimate.symbol}: none"
    slope = interval(*(part[i] for part in _slope(estimate)))
    return f"{force_label(loading.forces[i])}, {estimate.symbol}: {slope}"


def _table(loading, shown):
    """One row a load, estimator and side b."""
    sides = loading.side * _SIDES
    parts = [
        pd.DataFrame(
            {
                "load_N": loading.forces[i],
                "estimator": estimate.label,
                "delta_sigma": estimate.value[i],
                "delta_sigma_low": estimate.low[i],
                "delta_sigma_high": estimate.high[i],
                "sigma_star_N_mm^-delta": fractal_pressure(
                    loading.scaling.isel(load=i), estimate.key, estimate.value[i]
                ),
                "b_mm": sides,
                "sigma_0_MPa": size_effect(loading, estimate, i, sides)[0],
                "specimen_b_mm": loading.side,
                "specimen_sigma_0_MPa": loading.forces[i] / loading.side**2,
            }
        )
        for i in shown
        for estimate in loading.estimates
    ]
    return pd.concat(parts, ignore_index=True)


def _caption(loading):
    verdicts = "; ".join(
        f"by {estimate.label} "
        + trend(
            loading.forces,
            2 - estimate.value,
            2 - estimate.high,
            2 - estimate.low,
            rising=False,
        )
        for estimate in loading.estimates
    )
    return (
        f"{opening(13, loading)} Extrapolation of eq. 6, not a measurement: nominal pressure that "
        "brings about the sigma* of each load on a joint of side b, with Delta_sigma and sigma* "
        f"from A_r(s) (solid) and from box counting (dashed), {loading.fit_ranges()}; "
        "markers show the pressures applied to "
        f"the specimen (b = {short(loading.side)} mm), which eq. 6 meets only where "
        "H_D = b^Delta_sigma. The paper has the slope's magnitude 2 - Delta_sigma fall as F rises: "
        f"{verdicts}. {disagreement(loading.scaling)}"
    )
