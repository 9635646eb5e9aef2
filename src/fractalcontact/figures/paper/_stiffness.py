"""Stiffness of the interface over the spacing, tangent and initial, in the closure figure."""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import NullLocator

from ...core.estimate import Estimate
from ...core.verdicts import UNDETERMINED
from ...core.window import cell_side
from ...mechanics.states import chosen_offset
from ..kit.drawing import MARKERS, dilatancy_loads, label_short_span, nearest_load
from ..kit.empty import TOO_FULL, different_reasons, missing_lines, say_empty
from ..kit.points import draw_points, reach
from ..kit.words import force_label, percent, short

#: Greys and markers of the loads: colours and the other markers stand for offsets in this figure.
_GREYS, _MARKERS = ("0.65", "0.45", "0.25", "0"), MARKERS[5:]


def stiffness_table(curves: xr.Dataset, settings: dict, specimen: xr.Dataset) -> pd.DataFrame:
    """Tangent stiffness at the loads asked for, and k_ni, at every resolution of one offset."""
    curves = curves.sel(offset=chosen_offset(settings["map_offset"], curves["offset"].values))
    forces = curves["normal_force"].values
    mapped = nearest_load(forces, settings["map_load"], specimen)
    loads = sorted({*dilatancy_loads(forces, settings, specimen), mapped})
    rows = []
    for k in np.sort(curves["resolution"].values):
        curve = curves.sel(resolution=k)
        row = {"spacing_mm": k * cell_side(specimen), "offset_mm": float(curve["offset"])}
        quantity = {
            "quantity": "k_ni, extrapolated to zero load",
            "resolved": True,
            "determined": bool(curve["hyperbola_k_ni_determined"]),
        }
        columns = Estimate.read(curve, "hyperbola_k_ni").columns("stiffness", "MPa/mm")
        rows.append(row | quantity | columns)
        rows += [
            row
            | {
                "quantity": "tangent",
                "force_N": forces[j],
                "nominal_pressure_MPa": float(curve["nominal_pressure"][j]),
                "stiffness_MPa_per_mm": float(curve["interface_stiffness"][j]),
                "stiffness_missing_because": str(curve["interface_stiffness_reason"][j].item()),
                "resolved": bool(curve["resolved"][j]),
                "map_load": j == mapped,
            }
            for j in loads
        ]
    return pd.DataFrame(rows)


def draw_stiffness(axes: Axes, table: pd.DataFrame) -> None:
    """Tangent stiffness and k_ni over the spacing.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    table : pd.DataFrame
        Of :func:`stiffness_table`.
    """
    known = table.dropna(subset="stiffness_MPa_per_mm")
    tangent = known[known["quantity"] == "tangent"]
    for n, (force, points) in enumerate(tangent.groupby("force_N")):
        style: dict[str, Any] = {
            "color": _GREYS[n % len(_GREYS)],
            "marker": _MARKERS[n % len(_MARKERS)],
            "ms": 5,
        }
        draw_points(
            axes,
            points["spacing_mm"],
            points["stiffness_MPa_per_mm"],
            points["resolved"],
            ls="-",
            lw=0.7,
            label=f"tangent, $F$ = {force_label(force)}: {_numbers(points)}",
            **style,
        )
    initial = known[known["quantity"] != "tangent"]
    if len(initial):
        value, low, high = Estimate.read(initial, "stiffness", unit="MPa/mm").ends
        axes.errorbar(
            initial["spacing_mm"],
            value,
            yerr=reach(value, low, high),
            color="0",
            marker="_",
            ls=(0, (4, 2)),
            lw=0.8,
            capsize=2,
            label=f"$k_{{ni}}$ of the hyperbola, bars 95 %:{_initial_numbers(initial)}",
        )
    axes.set_xscale("log")
    if len(known):
        axes.set_yscale("log")
        # Room for the legend above all points.
        low, high = axes.get_ylim()
        axes.set_ylim(low, high * (high / low) ** 1.0)
        title = "at the finest $s$ (change at $2s$), MPa/mm"
        axes.legend(loc="upper left", handlelength=1.5, title=title, title_fontsize=7)
    else:
        why = different_reasons(_reasons(table))
        say_empty(axes, "\n".join(why) or TOO_FULL)
    axes.set_xlabel("spacing $s$ (mm)")
    axes.set_ylabel(r"stiffness $\mathrm{d}\sigma_0/\mathrm{d}w_\mathrm{int}$ (MPa/mm)")
    label_short_span(axes.yaxis)
    spacings = table["spacing_mm"].unique()
    axes.set_xticks(spacings, [short(s) for s in spacings])
    axes.xaxis.set_minor_locator(NullLocator())


def missing_stiffness(table: pd.DataFrame) -> list[str]:
    """Lines of the legend on tangent stiffnesses that are missing beside others."""
    if table["stiffness_MPa_per_mm"].isna().all():
        return []  # the panel says it
    return missing_lines(_reasons(table), "d")


def _reasons(table):
    return table.loc[table["quantity"] == "tangent", "stiffness_missing_because"]


def stiffness_words(table: pd.DataFrame) -> str:
    """What twice the spacing makes of the tangent stiffness at the map load, and of k_ni."""
    tangent = table[table["map_load"].eq(True)]
    at = force_label(tangent["force_N"].iloc[0])
    value, change = _with_change(tangent)
    if not np.isfinite(value):
        why = tangent.sort_values("spacing_mm")["stiffness_missing_because"].iloc[0]
        return f"No tangent stiffness at {at}: {why}."
    if not change:
        return f"Tangent stiffness at {at}: {short(value)} MPa/mm."
    _, initial = _with_change(table[table["quantity"] != "tangent"])
    also = f", k_ni by {initial}" if initial else ""
    return f"Twice the spacing changes tangent stiffness at {at} by {change}{also}."


def _initial_numbers(rows):
    """As :func:`_numbers` of k_ni; in a line of its own where the atlas calls it undetermined."""
    finest = rows.loc[rows["spacing_mm"].idxmin()]
    known = _numbers(rows)
    return f" {known}" if finest["determined"] else f"\n{UNDETERMINED}, {known}"


def _numbers(rows):
    """A stiffness at the finest spacing with its change at twice that, for a legend."""
    value, change = _with_change(rows)
    return f"{short(value)} ({change})" if change else f"{short(value)}"


def _with_change(rows):
    """A stiffness at the finest spacing, and the change that twice that makes of it, in words."""
    values = rows.sort_values("spacing_mm")["stiffness_MPa_per_mm"].values
    spacings = rows["spacing_mm"].sort_values().values
    doubled = len(values) > 1 and spacings[1] < 2.1 * spacings[0]
    if not doubled or not np.isfinite(values[:2]).all():
        return values[0], ""
    return values[0], percent(values[1] / values[0] - 1, "+")
