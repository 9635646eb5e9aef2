"""Yielded nodes and permanent set over the load, and the map of the set."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import FigureBase

from ...core.text import length_unit, pressure_label
from .. import kit

#: Label and marker of the fractions of the loading branch.
_FRACTIONS = {
    "yielded_fraction": ("fraction of the window", "o"),
    "plastic_load_fraction": ("fraction of the force on nodes at $H$", "s"),
}


def draw_permanent_set(
    figure: FigureBase, data: xr.Dataset, sides: tuple[float, float]
) -> list[kit.Panel]:
    """Panels (c) to (e): yielded nodes and set against pressure, and the set of each node.

    `data` is the stage ``branches``, `sides` (y, x) those of the window, mm.
    """
    axes = figure.subplots(1, 3, width_ratios=[1, 1, 1.15])
    top = pressure_label(float(data["nominal_pressure"][-1]))
    titles = ("nodes that yield", "set on loading", f"set of each node, {top}")
    panels = kit.panels_of(axes, titles, "cde")
    fractions, volume, where = panels
    load = data.sel(branch="load")
    for n, (name, (label, marker)) in enumerate(_FRACTIONS.items()):
        style: dict[str, Any] = {"color": kit.colour_of(n), "marker": marker, "ls": "-", "ms": 4}
        shown = load.assign({name: load[name].where(load[name] > 0)})
        fractions.curve(shown, "nominal_pressure", name, label=label, **style)
    fractions.axes.set(xscale="log", yscale="log", ylabel="fraction (1)")
    shown = load.assign(set_volume=load["set_volume"].where(load["set_volume"] > 0))
    line: dict[str, Any] = {"color": kit.colour_of(2), "marker": "^", "ls": "-", "ms": 4}
    volume.curve(shown, "nominal_pressure", "set_volume", **line)
    volume.axes.set(xscale="log", yscale="log", ylabel="volume pressed in (mm$^3$)")
    for panel in (fractions, volume):
        panel.axes.set_xlabel(f"{kit.NOMINAL_PRESSURE} (MPa)")
    depth = data["permanent_set"].values
    unit, size = length_unit(float(depth.max()))
    image = np.where(depth > 0, depth / size, np.nan)
    drawn = kit.draw_map(where.axes, image, sides, ticks=3, cmap="viridis_r")
    where.axes.set_facecolor("white")
    figure.colorbar(drawn, ax=where.axes, label=f"permanent set ({unit})")
    kit.legends_below(figure, [kit.heading("(c)")], *([one] for one in kit.entries(fractions.axes)))
    where.keep(data, "branch_maximum", "residual_closure", "dissipated_energy", "recovered_energy")
    return panels
