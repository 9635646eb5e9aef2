"""Test problems, styles of methods and axes shared by the figures of accuracy and speed."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from xarray import DataTree

from fractalcontact.figures.kit.drawing import COLOURS, LINES, MARKERS, colour_of
from fractalcontact.figures.kit.legends import entries

from ...accuracy.speed import MODEL, OURS, PEER, SOLVER

_COLOURS = tuple(colour_of(i) for i in range(1, len(COLOURS) - 1))
#: Solvers have filled marks, public codes hollow ones on a line, models hollow ones alone.
_OF_KIND: dict[str, dict[str, Any]] = {
    SOLVER: {"ls": LINES[1], "lw": 0.8},
    PEER: {"mfc": "white", "ls": LINES[2], "lw": 0.8},
    MODEL: {"mfc": "none", "ls": "none"},
}
_OURS = {"color": COLOURS[0], "marker": MARKERS[0], "ls": "-", "lw": 1.6, "zorder": 3}


def scenes_of(atlas: DataTree) -> dict[str, xr.Dataset]:
    """Datasets of the test problems measured, by name, in order of size, H and contact."""
    problems = {name: node.to_dataset().load() for name, node in atlas["speed"].children.items()}
    return dict(sorted(problems.items(), key=lambda item: _place(item[1].attrs)))


def _place(attrs):
    size, *smooth = (attrs[key] for key in ("size", "hurst", "contact"))
    return size, *np.nan_to_num(smooth, nan=np.inf), attrs["scene"]


def rough(scenes: dict[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """Test problems on self-affine surfaces."""
    return {name: scene for name, scene in scenes.items() if np.isfinite(scene.attrs["hurst"])}


def values_of(scenes: dict[str, xr.Dataset], key: str) -> list:
    """Distinct values of an attribute, ascending."""
    return sorted({scene.attrs[key] for scene in scenes.values()})


def middle_contact(scenes: dict[str, xr.Dataset]) -> float:
    """Share in contact that represents all where there is room for one."""
    shares = values_of(scenes, "contact")
    return shares[len(shares) // 2]


def styles(scenes: dict[str, xr.Dataset]) -> dict[str, dict]:
    """Colour, marker and line of every method, in every figure alike; ours alone is black."""
    kinds: dict[str, str] = {}
    for scene in scenes.values():
        kinds |= dict(zip(scene["method"].values, scene["kind"].values, strict=True))
    style_of = {OURS: _OURS}
    for i, (method, kind) in enumerate((m, k) for m, k in kinds.items() if m != OURS):
        style: dict[str, Any] = {
            "color": _COLOURS[i % len(_COLOURS)],
            "marker": MARKERS[(i + 1) % len(MARKERS)],
        }
        style_of[method] = style | _OF_KIND[kind]
    return style_of


def legend_of(figure: FigureBase, panels: Iterable[Axes], ncols: int = 4) -> None:
    """One legend below a figure with the entries of all its panels."""
    handles = {handle.get_label(): handle for axes in panels for handle in entries(axes)}
    figure.legend(handles=list(handles.values()), loc="outside lower center", ncols=ncols)
