"""All measured contact maps with their cells in contact."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.text import compact, percent
from ...core.verdicts import BEYOND_RANDOM
from .. import kit

TITLE = "Measured contact maps"
SUBJECT = "study"
NEEDS = ("contact_maps",)
KEY = "contact_maps"
ORDER = 300

#: Number of maps side by side, of a few and of many, and maximum number, so that each can be read.
_COLUMNS, _NARROW, _MOST = 4, 5, 60
#: Maximum length of a map's title, letters.
_LONGEST = 22


def draw(atlas: DataTree, specimens: list[str]) -> kit.Drawing:
    """Cells in contact of every map, its load, contact fraction and dimension."""
    series = kit.measured_series(atlas)
    maps = [(name, one) for each in series for name, one in zip(each.names, each.maps, strict=True)]
    chosen = [maps[i] for i in kit.spread(len(maps), _MOST)]
    columns = min(_COLUMNS if len(chosen) <= 2 * _COLUMNS else _NARROW, len(chosen))
    rows = -(-len(chosen) // columns)
    side = kit.WIDTH / columns
    tallest = max(_sides(one)[0] / _sides(one)[1] for _, one in chosen)
    figure = Figure(figsize=(kit.WIDTH, rows * (0.8 * side * min(tallest, 2) + 0.75) + 0.6))
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in panels[len(chosen) :]:
        axes.remove()
    for n, (axes, (name, one)) in enumerate(zip(panels, chosen, strict=False)):
        image = np.where(one["measured"], one["in_contact"], np.nan)
        kit.draw_map(axes, image, _sides(one), ticks=3, cmap="Greys", vmin=0, vmax=1)
        axes.set_title(_title(name, one), loc="left", fontsize=6)
        axes.tick_params(labelsize=6)
        if n % columns:
            axes.set_ylabel("")
        if n + columns < len(chosen):
            axes.set_xlabel("")
    figure.legend(handles=_key(one for _, one in chosen), loc="outside lower center", ncols=3)
    shown = f"{len(chosen)} of {len(maps)} maps" if len(chosen) < len(maps) else f"{len(maps)} maps"
    kit.headline(figure, f"{shown}, each with its nominal pressure; in brackets 95 % intervals")
    shares = [float(one["area_share"]) for _, one in maps]
    words = {
        "maps": len(maps),
        "thresholds": kit.threshold_words(series),
        "least": min(shares),
        "most": max(shares),
        "different": sum(one["null_verdict"].item() == BEYOND_RANDOM for _, one in maps),
        "warned": sum(bool(one.attrs["warning"]) for _, one in maps),
    }
    return kit.Drawing(figure, kit.table_of_maps(series), kit.caption(__name__, **words))


def _key(maps):
    """Legend of black, white and grey, of those that are drawn."""
    outline = {"edgecolor": "0.4", "lw": 0.5}
    handles = [
        Patch(facecolor="black", label="in contact", **outline),
        Patch(facecolor="white", label="not in contact", **outline),
    ]
    return handles + (
        [kit.missing_patch()] if any(not one["measured"].all() for one in maps) else []
    )


def _sides(one):
    """Sides (y, x) of a map, mm."""
    return tuple(one.sizes[axis] * one.attrs[f"spacing_{axis}"] for axis in "yx")


def _title(name, one):
    """Name, load, contact fraction and dimension of a map, a line each."""
    name = name if len(name) <= _LONGEST else f"{name[: _LONGEST - 1]}…"
    pressure = float(one["nominal_pressure"])
    load = f"{compact(pressure)} MPa" if np.isfinite(pressure) else "no load"
    dimension = Estimate.read(one, "delta_sigma", scale=DIMENSION)
    words = rf"$\Delta_\sigma$ = {dimension.text()}" if dimension.known else "no dimension"
    share = percent(float(one["area_share"]))
    return f"{name.replace('$', '')}\n{load}, $A_r/A_0$ = {share}\n{words}"
