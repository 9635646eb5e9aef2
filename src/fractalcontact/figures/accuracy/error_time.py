"""Error of the force against time on the rough test problems, with the Pareto front."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...accuracy.speed import LEADS_BELOW, MODEL, OURS, ahead_of_ours
from ..kit.drawing import WIDTH, Drawing, letter
from ..kit.words import SUPPLEMENTARY, short
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
SUBJECT = "accuracy"
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
    words = (
        f"{SUPPLEMENTARY} Error of the force against wall time on self-affine surfaces "
        f"({_runs_words(scenes)}). {caption(scenes, 'force_error')}"
    )
    return Drawing(figure, table_of(scenes), words)


def caption(scenes: dict[str, xr.Dataset], quantity: str) -> str:
    """Whether ours is on the front at every error below `LEADS_BELOW`, and what counts as equal.

    Parameters
    ----------
    scenes : dict
    quantity : str
        ``force_error`` or ``pressure_error``.

    Returns
    -------
    str
    """
    leads = sum(
        not ahead_of_ours(scene, quantity=quantity, models=False).sizes["point"]
        for scene in scenes.values()
    )
    models = sum(
        bool((ahead_of_ours(scene, quantity=quantity)["kind"] == MODEL).any())
        for scene in scenes.values()
    )
    alike = max(scene.attrs["told_apart_to"] for scene in scenes.values())
    worst = max(scene.attrs["reference_error"] for scene in scenes.values())
    return (
        f"{OURS} is on the solvers' Pareto front at every error below {LEADS_BELOW:g} on {leads} "
        f"of {len(scenes)} test problems, a cheaper model ahead on {models}. Errors below "
        f"{short(alike)} count as equal; the references' own is at most {short(worst)}."
    )


def _runs_words(scenes):
    """How the times were taken."""
    runs = int(max(scene["runs"].max() for scene in scenes.values()))
    threads = next(iter(scenes.values())).attrs["threads"]
    return f"cold solves, medians of up to {runs} runs, threads: {threads}"
