"""One surface elastic and crushing at its wall strength: change with the grid and the load."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.labels import printable
from ...core.limits import RESOLVED_NODES
from ...core.subject import Subject
from ...core.text import compact
from .. import kit

TITLE = "Fig. 12 and grid convergence: elastic contact beside contact that crushes"
SUBJECT = "study"
NEEDS = ("specimens", "closure", "domains")
KEY = "capped_variants"
ORDER = 8

_LETTERS = "abcdefghi"
_SPACING = "closure from the seat; $s$: spacing of the scan"
#: Maximum length of a label in the caption, letters.
_LONGEST = 40
#: Maximum number of pairs, for which a page has room.
_MAX_PAIRS = 3


def draw(atlas: DataTree, names: Sequence[str]) -> kit.Drawing:
    """Closure from the seat at every resolution, elastic and capped, and Delta_sigma of both."""
    pairs = _pairs([Subject.of(atlas, name) for name in names])[:_MAX_PAIRS]
    figure = Figure(figsize=(kit.WIDTH, 2.6 * max(len(pairs), 1) + 0.8))
    if not pairs:
        kit.say_empty(figure.subplots(), "no surface of the study is both elastic and capped")
        return kit.Drawing(figure, kit.table_of(), kit.caption(__name__, pairs=[]))
    panels: list[kit.Panel] = []
    for part, pair in zip(
        figure.subfigures(len(pairs), 1, squeeze=False)[:, 0], pairs, strict=True
    ):
        row, letters = part.subplots(1, 3, sharex=True), _LETTERS[len(panels) :]
        row[1].sharey(row[0])
        for axes, which, one in zip(row, letters, pair, strict=False):
            panels.append(kit.Panel(axes, which, _model(one)))
            _draw_closures(panels[-1], one)
        panels.append(kit.Panel(row[2], letters[2], r"$\Delta_\sigma$ by box counting"))
        _draw_dimensions(panels[-1], pair)
        kit.headline(part, pair[0].label, kit.place(pair[0].direction, pair[0].offset))
    of_grid = [kit.heading(_SPACING), *panels[0].entries]
    few = f"hollow: fewer than {RESOLVED_NODES} nodes touch"
    kit.legends_below(
        figure,
        of_grid,
        [kit.heading("dimension, 95 %"), *panels[2].entries, kit.heading(few)],
    )
    return kit.Drawing(
        figure, kit.table_of(*panels), kit.caption(__name__, pairs=[_words(*p) for p in pairs])
    )


def _pairs(subjects: Sequence[Subject]) -> list[tuple[Subject, Subject]]:
    """Elastic and capped specimens of one scan, in the order of the study."""
    elastic = {_scan(one): one for one in subjects if not one.settings["capped_variant"]}
    capped = [one for one in subjects if one.settings["capped_variant"]]
    return [(elastic[_scan(one)], one) for one in capped if _scan(one) in elastic]


def _scan(subject: Subject) -> str:
    """Checksum of the scan of a specimen."""
    return str(json.loads(subject["specimens"].attrs["lower_scan"])["sha256"])


def _model(subject: Subject) -> str:
    """Material model of a specimen in words, by its largest pressure."""
    hardness = subject.settings["material"]["hardness"]
    return "elastic" if not np.isfinite(hardness) else f"capped at {compact(hardness, 6)} MPa"


def _draw_closures(panel: kit.Panel, subject: Subject) -> None:
    """Closure from the seat over the load at each resolution."""
    curves = kit.prefractals(subject, "closure")
    labels = ["$s$" if k == 1 else f"{k} $s$" for k in curves["resolution"].values]
    style: dict[str, Any] = {"ls": "-", "lw": 0.9, "ms": 3.5, "labels": labels}
    style |= {"hue": "resolution", "filled": "resolved"}
    panel.curves(curves, "nominal_pressure", "closure_from_stated_seat", **style)
    _pressure_axis(panel.axes)
    panel.axes.set_ylabel("closure from the seat (mm)")


def _draw_dimensions(panel: kit.Panel, pair: tuple[Subject, Subject]) -> None:
    """Delta_sigma of both specimens over the load."""
    for n, subject in enumerate(pair):
        style: dict[str, Any] = {"color": kit.colour_of(5 * n), "marker": kit.MARKERS[n], "ms": 3.5}
        label = "capped at the wall strength" if n else "elastic"
        states = subject.states("domains")
        panel.curve(states, "nominal_pressure", "delta_sigma", label=label, **style)
    _pressure_axis(panel.axes)
    panel.axes.set(ylim=(-0.05, 2.05), ylabel=r"dimension $\Delta_\sigma$ (1)")


def _pressure_axis(axes: Axes) -> None:
    axes.set_xscale("log")
    axes.set_xlabel(f"{kit.NOMINAL_PRESSURE} (MPa)")


def _words(elastic: Subject, capped: Subject) -> dict[str, Any]:
    """Values of the caption of a pair."""
    both = (elastic, capped)
    states, curves = ([one.states(of) for one in both] for of in ("domains", "closure"))
    return {
        "label": printable(elastic.label, _LONGEST),
        "dimensions": [Estimate.read(one, "delta_sigma", scale=DIMENSION)[-1] for one in states],
        "pressures": [float(curve["nominal_pressure"][-1]) for curve in curves],
        "changes": [float(curve["seated_k_ni_change"]) for curve in curves],
    }
