"""Fig. 12: the contact domain and its dimension as the joint closes."""

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.domains import Loading, disagreement, rise_words
from ..kit.drawing import MARKERS, WIDTH, Drawing, colour_of, group, headline, letter
from ..kit.maps import draw_domain
from ..kit.words import force_label, percent, wrapped

TITLE = "Fig. 12: contact domains and their dimension under growing load"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "contact_maps", "statements")
ORDER = 190

#: Contact domains drawn.
_MOST_MAPS = 6

#: The two estimates stand this factor of F apart, so that neither hides the other.
_APART = {"area": 1 / 1.04, "box": 1.04}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Contact domains under growing load, and Delta_sigma against F by both estimators."""
    loading = Loading.of(atlas, name)
    shown = loading.spread_loads(_MOST_MAPS)
    aspect = loading.sides[0] / loading.sides[1]
    map_height = WIDTH / _MOST_MAPS * aspect + 0.75
    figure = Figure(figsize=(WIDTH, map_height + 2.6))
    top, bottom = figure.subfigures(2, 1, height_ratios=[map_height, 2.6])  # type: ignore[misc]  # an array
    maps = top.subplots(1, len(shown), squeeze=False, sharey=True)[0]
    nominal = np.prod(loading.sides)
    finest = loading.scaling["area"].sel(resolution=loading.finest).values
    for axes, which, i in zip(maps, "abcdef", shown, strict=False):
        draw_domain(axes, loading.domain(loading.finest, i), loading.sides, ticks=3)
        share = percent(finest[i] / nominal)
        letter(axes, which, f"{force_label(loading.forces[i])}\n$A_r/A_0$ = {share}")
        axes.label_outer()
    axes = bottom.subplots()
    measured = measured_maps(atlas)
    _draw_dimensions(axes, loading)
    _draw_measured(axes, measured, nominal)
    letter(axes, "abcdefg"[len(shown)], "dimension of the contact domain and load")
    headline(figure, *loading.title)
    table = pd.concat([_table(loading, finest), *_measured_rows(measured, nominal)])
    rises = rise_words(atlas, name, loading)
    caption = f"{_caption(loading, rises)}{_measured_words(measured)}"
    return Drawing(figure, table.reset_index(drop=True), caption)


def measured_maps(atlas: DataTree) -> dict[str, xr.Dataset]:
    """Measured contact maps that were dropped in with the scans, by name."""
    if "contact_maps" not in atlas.children:
        return {}
    return {name: group(atlas, "contact_maps", name) for name in atlas["contact_maps"].children}


def _measured_rows(measured, nominal):
    """Rows of the table for the maps: their load is that of the window at their pressure."""
    return [
        pd.DataFrame(
            {
                "load_N": [float(found["nominal_pressure"]) * nominal],
                "area_mm2": [float(found["area_share"]) * nominal],
                "estimator": [f"box counting, measured: {found.attrs['label']}"],
                "delta_sigma": [float(found["delta_sigma"])],
                "delta_sigma_low": [float(found["delta_sigma_low"])],
                "delta_sigma_high": [float(found["delta_sigma_high"])],
                "reason": [found["reason"].item()],
            }
        )
        for found in measured.values()
    ]


def _draw_measured(axes, measured, nominal):
    """Measured domains at the force that gives the window their nominal pressure."""
    for n, one in enumerate(measured.values()):
        value, low, high = (float(one[f"delta_sigma{end}"]) for end in ("", "_low", "_high"))
        pressure = float(one["nominal_pressure"])
        style = {"color": colour_of(n + 3), "marker": MARKERS[(n + 3) % len(MARKERS)]}
        label = f"measured: {one.attrs['label']}"
        if np.isfinite(pressure):
            reach = [[max(value - low, 0)], [max(high - value, 0)]]
            axes.errorbar(
                pressure * nominal, value, yerr=reach, ls="none", capsize=2, label=label, **style
            )
        else:  # without a load it has no place along F
            axes.axhline(value, color=style["color"], ls="-.", lw=0.9, label=f"{label}, no load")
    if measured:
        axes.autoscale(axis="x")
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0)


def _measured_words(measured):
    """Range of Delta_sigma by box counting of the measured domains."""
    values = [float(one["delta_sigma"]) for one in measured.values()]
    known = [value for value in values if np.isfinite(value)]
    if not known:
        return f" Measured maps: {len(values)}, without a dimension." if values else ""
    ends = dict.fromkeys(f"{end:.2f}" for end in (min(known), max(known)))
    return f" Measured maps: {' to '.join(ends)} by box counting."


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
        reach = np.array([estimate.value - estimate.low, estimate.high - estimate.value])
        known = np.isfinite(estimate.value)
        axes.errorbar(
            loading.forces * _APART[estimate.key],
            estimate.value,
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


def _caption(loading, rises):
    return (
        f"{loading.opening('Fig. 12')} Contact domains and Delta_sigma under rising load "
        f"({loading.fit_ranges()}). The paper's rise with F: {rises}. "
        f"{disagreement(loading.scaling)}"
    )
