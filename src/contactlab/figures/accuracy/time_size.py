"""Wall time and memory against the size of the grid, with exponents."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from fractalcontact.core.estimate import EXPONENT, Estimate
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing, colour_of, group
from fractalcontact.figures.kit.titles import letter

from ...accuracy.speed import OURS
from ._speed import legend_of, middle_contact, rough, scenes_of, styles

TITLE = "Wall time and memory against the size of the grid"
SUBJECT = "study"
NEEDS = ("speed", "speed_growth")
KEY = "speed"
ORDER = 70

_ROWS = {"seconds": ("wall time (s)", 1.0), "memory": ("peak memory (MB)", 1e6)}


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Wall time over peak memory, a column for each H at the middle contact."""
    growth = group(atlas, "speed_growth", "surfaces")
    scenes = rough(scenes_of(atlas))
    looks = styles(scenes)
    columns = _middle(scenes)
    figure = Figure(figsize=(WIDTH, 6.4))
    panels = figure.subplots(2, len(columns), sharex=True, sharey="row", squeeze=False)
    for j, surface in enumerate(columns):
        of_surface = growth.sel(surface=surface)
        for i, name in enumerate(_ROWS):
            _draw_growth(panels[i, j], of_surface, name, looks)
            letter(panels[i, j], "abcdefgh"[i * len(columns) + j], surface)
        _draw_bounds(panels[0, j], of_surface)
        panels[-1, j].set_xlabel("nodes per side (1)")
    for i, (label, _) in enumerate(_ROWS.values()):
        panels[i, 0].set_ylabel(label)
    legend_of(figure, panels.flat, ncols=3)
    return Drawing(figure, _table(growth), caption(__name__, **_numbers(growth, columns)))


def _middle(scenes):
    """Names of the surfaces at the middle contact, one for each H."""
    middle = middle_contact(scenes)
    names = [s.attrs["scene"] for s in scenes.values() if s.attrs["contact"] == middle]
    return sorted({name.split(", ", 1)[1] for name in names})


def _draw_growth(axes, one, name, looks):
    sizes, scale = one["size"].values, _ROWS[name][1]
    for solver in one["solver"].values:
        values = one[name].sel(solver=solver).values / scale
        if np.isfinite(values).any():
            axes.plot(sizes, values, **looks[solver], label=solver)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xticks(sizes, [str(size) for size in sizes])


def _draw_bounds(axes, one):
    """Our applications of the operator alone, and n log n through the first of their points."""
    nodes, bound = np.square(one["size"].values, dtype=float), one["bound"].values
    style = {"color": colour_of(0), "lw": 1.0}
    axes.plot(one["size"], bound, ls="--", label=f"applications of K by {OURS}, alone", **style)
    line, there = nodes * np.log(nodes), np.flatnonzero(np.isfinite(bound))
    if there.size:
        line *= bound[there[0]] / line[there[0]]
        axes.add_line(Line2D(one["size"].values, line, ls=":", label="n log n, n nodes", **style))


def _table(growth):
    """Table of times and memories with a row for each surface, solver and size."""
    columns = ["seconds", "memory", "reached", "bound"]
    columns += [name for name in growth.data_vars if "exponent" in name]
    table = growth[columns].to_dataframe().reset_index()
    units = {"seconds": "seconds_s", "memory": "memory_B", "bound": "bound_s"}
    return table.rename(columns=units)


def _numbers(growth, columns):
    """Growth of our time and memory on each surface, and the operator's share of the time."""
    surfaces = []
    for surface in columns:
        ours = growth.sel(surface=surface, solver=OURS)
        part = 100 * (ours["bound"] / ours["seconds"])
        time, memory = (
            Estimate.read(ours, f"{name}_exponent", scale=EXPONENT)
            for name in ("seconds", "memory")
        )
        surfaces.append(
            (surface, time, memory, f"{float(part.min()):.0f}", f"{float(part.max()):.0f}")
        )
    return {"error": growth.attrs["error"], "surfaces": surfaces}
