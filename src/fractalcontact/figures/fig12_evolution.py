"""Fig. 12: the contact domain and its dimension as the joint closes."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ._domains import Loading, disagreement, draw_domain, opening, short, trend, wrapped
from .common import WIDTH, Drawing, force_label

#: Contact domains drawn.
_MOST_MAPS = 6

#: The two estimates stand this factor of F apart, so that neither hides the other.
_APART = {"area": 1 / 1.04, "box": 1.04}


def draw(atlas, name):
    """Contact domains under growing load, and Delta_sigma against F by both estimators.

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
    shown = loading.spread_loads(_MOST_MAPS)
    aspect = loading.sides[0] / loading.sides[1]
    map_height = WIDTH / _MOST_MAPS * aspect + 0.6
    figure = Figure(figsize=(WIDTH, map_height + 2.6))
    top, bottom = figure.subfigures(2, 1, height_ratios=[map_height, 2.6])
    maps = top.subplots(1, len(shown), squeeze=False, sharey=True)[0]
    nominal = np.prod(loading.sides)
    finest = loading.scaling["area"].sel(resolution=loading.finest).values
    for axes, letter, i in zip(maps, "abcdef", shown, strict=False):
        draw_domain(axes, loading.domain(loading.finest, i), loading.sides)
        axes.set_title(
            f"({letter}) {force_label(loading.forces[i])}\n"
            f"$A_r/A_0$ = {100 * finest[i] / nominal:.2g} %"
        )
        axes.set_xlabel("$x$ (mm)")
    maps[0].set_ylabel("$y$ (mm)")
    axes = bottom.subplots()
    _draw_dimensions(axes, loading)
    axes.set_title(rf"({'abcdefg'[len(shown)]}) dimension of the contact domain and load")
    return Drawing(figure, _table(loading, finest), _caption(loading, shown))


def _table(loading, area):
    """One row a load and estimator."""
    return pd.concat(
        [
            pd.DataFrame(
                {
                    "load_N": loading.forces,
                    "offset_mm": loading.offset,
                    "area_mm2": area,
                    "estimator": estimate.label,
                    "delta_sigma": estimate.value,
                    "delta_sigma_low": estimate.low,
                    "delta_sigma_high": estimate.high,
                    "reason": estimate.reason,
                }
            )
            for estimate in loading.estimates
        ],
        ignore_index=True,
    )


def _draw_dimensions(axes, loading):
    for estimate in loading.estimates:
        known = np.isfinite(estimate.value)
        value = estimate.value[known]
        reach = np.array([value - estimate.low[known], estimate.high[known] - value])
        axes.errorbar(
            loading.forces[known] * _APART[estimate.key],
            value,
            # Rounding may leave an exact fit's interval a hair's breadth below zero.
            yerr=np.maximum(reach, 0),
            **estimate.style,
            capsize=2,
            elinewidth=0.8,
            label=f"{estimate.symbol},\n{known.sum()} of {known.size} loads",
        )
    if not any(np.isfinite(estimate.value).any() for estimate in loading.estimates):
        first = "\n".join(wrapped(estimate.reason[0]) for estimate in loading.estimates)
        axes.text(0.5, 0.5, first, transform=axes.transAxes, ha="center")
    axes.axhline(1, color="0.6", ls=":", lw=0.8, zorder=0)
    axes.set_xscale("log")
    axes.set_xlim(loading.forces.min() / 1.5, loading.forces.max() * 1.5)
    axes.set_ylim(-0.05, 2.05)
    axes.set_xlabel("normal force $F$ (N)")
    axes.set_ylabel(r"dimension $\Delta_\sigma$ (1)")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0)


def _caption(loading, shown):
    verdicts = "; ".join(
        f"by {estimate.label} "
        + trend(loading.forces, estimate.value, estimate.low, estimate.high, rising=True)
        for estimate in loading.estimates
    )
    return (
        f"{opening(12, loading)} Contact domains at s = {short(loading.finest_spacing)} mm under "
        f"{len(shown)} loads (rings mark nodes too few to be seen), and Delta_sigma with 95 % "
        f"intervals, which the axis may cut ({loading.fit_ranges()}). The paper has "
        f"Delta_sigma rise with F from 0: {verdicts}. {disagreement(loading.scaling)}"
        f"{_missing(loading)}"
    )


def _missing(loading):
    """Loads without an estimate, and why at the first."""
    sentences = []
    for estimate in loading.estimates:
        missing = [i for i, reason in enumerate(estimate.reason) if reason]
        if missing:
            forces = ", ".join(force_label(loading.forces[i]) for i in missing)
            first = estimate.reason[missing[0]]
            sentences.append(f" None by {estimate.label} at {forces}; at the first, {first}.")
    return "".join(sentences)
