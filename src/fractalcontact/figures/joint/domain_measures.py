"""Measures of the contact domain beside its box dimension: local slopes, lacunarity and D_q."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.subject import Subject
from ..kit.axes import label_short_span
from ..kit.caption import caption
from ..kit.domains import spread_loads
from ..kit.drawing import LINES, MARKERS, WIDTH, Drawing, colour_of
from ..kit.legends import entries, legends_below, mark
from ..kit.panel import Panel, table_of
from ..kit.titles import headline
from ..kit.words import force_label, place

TITLE = "Is the contact domain fractal: local slopes, lacunarity, dimensions of the pressure"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "domains", "domain_measures")
ORDER = 150

#: Loads drawn, the reference load among them.
MAX_LOADS = 3

#: What curves are compared with, in greys that no load has.
_LINE: dict[str, Any] = {"color": "0.6", "ls": (0, (1, 1)), "lw": 1.2, "zorder": 0}
_PLANE: dict[str, Any] = {"color": "0.6", "ls": "-", "lw": 1.2, "zorder": 0}
_EVEN: dict[str, Any] = {"color": "0.6", "ls": (0, (6, 2)), "lw": 1.2, "zorder": 0}
#: Opacity of intervals.
_FAINT = 0.15


def draw(atlas: DataTree, name: str) -> Drawing:
    """Local slopes of the box counts, lacunarity and the spectrum D_q of the pressure."""
    subject = Subject.of(atlas, name)
    measures, reference = subject["domain_measures"], subject.reported.reference
    some = np.flatnonzero(measures["lacunarity"].notnull().any("gliding_side").values)
    at = np.flatnonzero(some == reference)
    chosen = some[spread_loads(some.size, MAX_LOADS, int(at[0]) if at.size else None)]
    shown = measures.isel(normal_force=chosen)
    counts = subject.states("domains").sel(normal_force=shown["normal_force"])
    counts = counts.set_coords("local_slope_side")
    force = subject.reported.force

    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots(1, 3)
    titles = (
        "box counts: level if fractal",
        "lacunarity: 1 if even",
        "pressure: level if monofractal",
    )
    a, b, c = (Panel(*one) for one in zip(axes, "abc", titles, strict=True))
    _draw_loads(a, counts, "local_slope_side", "local_slope", force)
    _draw_loads(b, shown, "gliding_side", "lacunarity", force)
    _draw_loads(c, shown, "order", "generalised_dimension", force)
    _finish(a.axes, b.axes, c.axes, shown)
    legends_below(figure, entries(c.axes), _greys(), [_band_entry(shown, force)])
    headline(figure, subject.label, place(subject.direction, subject.offset))
    words = _values(measures.isel(normal_force=reference), subject.state("domains"))
    return Drawing(figure, table_of(a, b, c), caption(__name__, force=force, **words))


def _colours(shown):
    """Colour of each load, the same in all panels."""
    return {float(force): colour_of(n) for n, force in enumerate(shown["normal_force"].values)}


def _draw_loads(panel, shown, x, y, banded):
    """A curve a load; the interval of one alone."""
    axes = panel.axes
    panel.keep(shown, y)
    for n, (force, colour) in enumerate(_colours(shown).items()):
        state = shown.sel(normal_force=force)
        style = {"color": colour, "marker": MARKERS[n % len(MARKERS)], "ls": LINES[n % len(LINES)]}
        label = f"$F$ = {force_label(force)}"
        label += "" if np.isfinite(state[y]).any() else ": no $D_q$"
        axes.plot(state[x], state[y], ms=3, lw=0.8, label=label, **style)
        if force == banded:
            _, low, high = Estimate.read(state, y).ends
            # No lacunarity is less than 1, and none has a place below that.
            low = low.clip(min=1) if y == "lacunarity" else low
            axes.fill_between(state[x], low, high, color=colour, alpha=_FAINT, lw=0)


def _finish(slopes, lacunarity, spectrum, shown):
    """Axes and null models of the curves."""
    slopes.set_xscale("log")
    for level, style in ((1, _LINE), (2, _PLANE)):
        slopes.axhline(level, **style)
    slopes.set_ylim(-0.1, max(2.2, slopes.get_ylim()[1]))
    slopes.set(xlabel="box side $r$ (mm)", ylabel=r"local slope $-$d log $N$ / d log $r$ (1)")
    lacunarity.set(xscale="log", yscale="log", xlabel="side of the gliding box $r$ (mm)")
    lacunarity.axhline(1, **_EVEN)
    lacunarity.set_ylabel(r"lacunarity $\langle M^2\rangle/\langle M\rangle^2$ (1)")
    if shown.sizes["normal_force"]:
        # Bands may be open upwards where one part of the window holds nearly all contact.
        lacunarity.set_ylim(0.8, 3 * max(float(shown["lacunarity"].max()), 1.5))
    spectrum.axhline(2, **_PLANE)
    spectrum.set(xlabel="order $q$ (1)", ylabel="dimension $D_q$ of the pressure (1)")
    for axes in (slopes, lacunarity):
        label_short_span(axes.xaxis)


def _greys():
    """Legend entries except the curves of loads."""
    words = (
        (_LINE, "(a) 1: as of a line"),
        (_PLANE, "(a), (c) 2: as of a filled plane"),
        (_EVEN, "(b) 1: evenly filled"),
    )
    return [mark(label=label, **style) for style, label in words]


def _band_entry(shown, force):
    """The interval, in the colour drawn; without a domain there nothing is."""
    colour = _colours(shown).get(force, "0.5")
    label = f"95 % interval, {force_label(force)} alone"
    return Patch(color=colour, alpha=_FAINT, lw=0, label=label)


def _values(state, counts):
    """Values of the caption, at the reference load."""
    slopes, spectrum = counts["local_slope"], state["generalised_dimension"]
    complete = slopes.size > 1 and bool(slopes.notnull().all())
    spectrum = spectrum.sel(order=[0.0, 4.0]).values
    sides = counts["local_slope_side_min"].min(), counts["local_slope_side_max"].max()
    return {
        "slopes": [float(slopes.min()), float(slopes.max())] if complete else [],
        "sides": sides,
        "boxes": Estimate.read(counts, "delta_sigma", scale=DIMENSION),
        "pairs": Estimate.read(state, "correlation_dimension", scale=DIMENSION),
        "spectrum": spectrum if np.isfinite(spectrum).all() else [],
        "falls": bool(state["dimensions_fall"]),
    }
