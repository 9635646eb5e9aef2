"""Error of the force against time on the rough test problems, with the Pareto front."""

from collections.abc import Sequence
from typing import Any

import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing
from fractalcontact.figures.kit.titles import letter

from ...accuracy.speed import LEADS_BELOW, MODEL, OURS, ahead_of_ours
from ._speed import (
    AXES,
    draw_points,
    legend_of,
    pick,
    rough,
    scenes_of,
    styles,
    table_of,
    values_of,
)

TITLE = "Error of the force against wall time on rough surfaces, with the Pareto front"
SUBJECT = "study"
NEEDS = ("speed",)
KEY = "speed"
ORDER = 50

_LETTERS = "abcdefghijklmnopqrstuvwxyz"


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """A panel for each H and contact, at the smallest and at the largest size."""
    scenes = rough(scenes_of(atlas))
    looks = styles(scenes)
    sizes = sorted({values_of(scenes, "size")[0], values_of(scenes, "size")[-1]})
    rows = [(hurst, size) for hurst in values_of(scenes, "hurst") for size in sizes]
    columns = values_of(scenes, "contact")
    figure = Figure(figsize=(WIDTH, 1.0 + 2.1 * len(rows)))
    panels = figure.subplots(len(rows), len(columns), sharey=True, sharex="row", squeeze=False)
    for i, (hurst, size) in enumerate(rows):
        for j, contact in enumerate(columns):
            axes = panels[i, j]
            scene = pick(scenes, hurst=hurst, size=size, contact=contact)
            draw_points(axes, scene, "force_error", looks)
            axes.axhline(LEADS_BELOW, color="0.5", lw=0.6, ls=":", label=f"error {LEADS_BELOW:g}")
            title = rf"$H$ = {hurst:g}, {100 * contact:g} %, {size}$^2$"
            letter(axes, _LETTERS[(i * len(columns) + j) % len(_LETTERS)], title)
        panels[i, 0].set_ylabel(AXES["force_error"])
    for axes in panels[-1]:
        axes.set_xlabel("wall time (s)")
    legend_of(figure, panels.flat)
    runs = int(max(scene["runs"].max() for scene in scenes.values()))
    threads = next(iter(scenes.values())).attrs["threads"]
    words = caption(__name__, runs=runs, threads=threads, **front(scenes, "force_error"))
    return Drawing(figure, table_of(scenes), words)


def front(scenes: dict[str, xr.Dataset], quantity: str) -> dict[str, Any]:
    """Counts of the problems on whose front ours is at every error below `LEADS_BELOW`.

    Parameters
    ----------
    scenes : dict
    quantity : str
        ``force_error`` or ``pressure_error``.
    """
    ahead = [ahead_of_ours(scene, quantity=quantity, models=False) for scene in scenes.values()]
    with_models = [ahead_of_ours(scene, quantity=quantity) for scene in scenes.values()]
    return {
        "ours": OURS,
        "below": f"{LEADS_BELOW:g}",
        "problems": len(scenes),
        "leads": sum(not found.sizes["point"] for found in ahead),
        "models": sum(bool((found["kind"] == MODEL).any()) for found in with_models),
        "alike": max(scene.attrs["resolvable_error"] for scene in scenes.values()),
        "worst": max(scene.attrs["reference_error"] for scene in scenes.values()),
    }
