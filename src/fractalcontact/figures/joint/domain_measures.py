"""Measures of the contact domain beside its box dimension: local slopes, lacunarity and D_q."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.subject import Subject
from ...core.text import force_label
from .. import kit

TITLE = "Is the contact domain fractal: local slopes, lacunarity, dimensions of the pressure"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "domains", "domain_measures")
ORDER = 150

#: Number of loads drawn, the reference load among them.
MAX_LOADS = 3

#: Lines with which curves are compared, in grey, which no load has.
_GREY: dict[str, Any] = {"color": "0.6", "lw": 1.2, "zorder": 0}
_LINE, _PLANE, _EVEN = (_GREY | {"ls": ls} for ls in ((0, (1, 1)), "-", (0, (6, 2))))
_TITLES = (
    "box counts: level if fractal",
    "lacunarity: 1 if even",
    "pressure: level if monofractal",
)


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Local slopes of the box counts, lacunarity and the spectrum D_q of the pressure."""
    subject = Subject.of(atlas, name)
    measures, reference = subject["domain_measures"], subject.reported.reference
    some = np.flatnonzero(measures["lacunarity"].notnull().any("gliding_side").values)
    index = np.flatnonzero(some == reference)
    chosen = some[kit.spread_loads(some.size, MAX_LOADS, int(index[0]) if index.size else None)]
    shown = measures.isel(normal_force=chosen)
    figure = Figure(figsize=(kit.WIDTH, 3.4))
    a, b, c = kit.panels_of(figure.subplots(1, 3), _TITLES)
    labels = [f"$F$ = {force_label(force)}" for force in shown["normal_force"].values]
    of_loads: dict[str, Any] = {"hue": "normal_force", "labels": labels, "ls": "-"}
    of_loads |= {"ms": 3, "lw": 0.8}
    counts = subject.states("domains").sel(normal_force=shown["normal_force"])
    a.curves(counts, "local_slope_side", "local_slope", **of_loads)
    b.curves(shown, "gliding_side", "lacunarity", **of_loads)
    c.curves(shown, "order", "generalised_dimension", **of_loads)
    _finish(a.axes, b.axes, c.axes, shown)
    greys = [one for panel in (a, b) for one in panel.entries[len(labels) :]]
    loads = a.entries[: len(labels)]
    kit.legends_below(figure, loads, [*greys, kit.heading("bars: 95 % intervals")])
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset))
    words = _values(measures.isel(normal_force=reference), subject.state("domains"))
    words["force"] = subject.reported.force
    return kit.Drawing(figure, kit.table_of(a, b, c), kit.caption(__name__, **words))


def _finish(slopes: Axes, lacunarity: Axes, spectrum: Axes, shown: xr.Dataset) -> None:
    """Axes and null models of the curves."""
    slopes.axhline(1, label="(a) 1: as of a line", **_LINE)
    slopes.axhline(2, label="(a), (c) 2: as of a filled plane", **_PLANE)
    slopes.set(xscale="log", ylim=(-0.1, max(2.2, slopes.get_ylim()[1])))
    slopes.set(xlabel="box side $r$ (mm)", ylabel=r"local slope $-$d log $N$ / d log $r$ (1)")
    lacunarity.axhline(1, label="(b) 1: evenly filled", **_EVEN)
    lacunarity.set(xscale="log", yscale="log", xlabel="side of the gliding box $r$ (mm)")
    lacunarity.set_ylabel(r"lacunarity $\langle M^2\rangle/\langle M\rangle^2$ (1)")
    if shown.sizes["normal_force"]:
        # Bars are open upwards where one part of the window holds nearly all contact.
        lacunarity.set_ylim(0.8, 3 * max(float(shown["lacunarity"].max()), 1.5))
    spectrum.axhline(2, **_PLANE)
    spectrum.set(xlabel="order $q$ (1)", ylabel="dimension $D_q$ of the pressure (1)")


def _values(state: xr.Dataset, counts: xr.Dataset) -> dict[str, Any]:
    """Values of the caption, at the reference load."""
    slopes = counts["local_slope"]
    complete = slopes.size > 1 and bool(slopes.notnull().all())
    spectrum = state["generalised_dimension"].sel(order=[0.0, 4.0]).values
    sides = counts["local_slope_side_min"].min(), counts["local_slope_side_max"].max()
    return {
        "slopes": [float(slopes.min()), float(slopes.max())] if complete else [],
        "sides": sides,
        "boxes": Estimate.read(counts, "delta_sigma", scale=DIMENSION),
        "pairs": Estimate.read(state, "correlation_dimension", scale=DIMENSION),
        "spectrum": spectrum if np.isfinite(spectrum).all() else [],
        "falls": bool(state["dimensions_fall"]),
    }
