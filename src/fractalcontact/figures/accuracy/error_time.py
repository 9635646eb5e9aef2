"""Error of the force against time on the rough scenes, with the Pareto front."""

import numpy as np
from matplotlib.figure import Figure

from ...accuracy.speed import LEADS_BELOW, MODEL, OURS, ahead_of_ours
from ..kit.drawing import WIDTH, Drawing, letter
from ..kit.words import short
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

_LETTERS = "abcdefghijklmnopqrstuvwxyz"


def draw(atlas, names):
    """A panel for each H and contact, at the smallest and at the largest size.

    Parameters
    ----------
    atlas : xr.DataTree
    names : list of str
        Not used: the scenes are the study's own.

    Returns
    -------
    Drawing
    """
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
    return Drawing(figure, table_of(scenes), caption(scenes, "force_error", "force"))


def caption(scenes, quantity, words):
    """Whether ours is on the front at every error below `LEADS_BELOW`, scene by scene.

    Parameters
    ----------
    scenes : dict
    quantity : str
        ``force_error`` or ``pressure_error``.
    words : str
        What it is the error of.

    Returns
    -------
    str
    """
    runs = int(max(scene["runs"].max() for scene in scenes.values()))
    alike = max(scene.attrs["told_apart_to"] for scene in scenes.values())
    worst = max(scene.attrs["reference_error"] for scene in scenes.values())
    return (
        f"In no figure of the paper: error of the {words} against wall time on self-affine "
        f"surfaces pressed by a closure from a cold start, medians of up to {runs} runs taken in "
        f"turn, {next(iter(scenes.values())).attrs['threads']} thread(s) of ours. "
        f"{_solvers(scenes, quantity)}. {_models(scenes, quantity)}. "
        f"Errors below {short(alike)} count as alike. The references' own error of the force is at "
        f"most {short(worst)}."
    )


def _solvers(scenes, quantity):
    """On how many scenes ours is on the front of the solvers at every error below the limit."""
    ahead = [ahead_of_ours(scene, quantity=quantity, models=False) for scene in scenes.values()]
    behind = [points for points in ahead if points.sizes["point"]]
    leads = [points.attrs["scene"] for points in ahead if not points.sizes["point"]]
    return (
        f"Among the solvers {OURS} is on the Pareto front at every error below {LEADS_BELOW:g} on "
        f"{len(leads)} of {len(scenes)} scenes (nodes a side, H, share in contact)"
        + (f": {'; '.join(leads)}" if leads else "")
        + (f". Not on: {_listed(behind, quantity)}" if behind else "")
    )


def _models(scenes, quantity):
    """Where a cheaper model is on the front below the limit."""
    ahead = [ahead_of_ours(scene, quantity=quantity) for scene in scenes.values()]
    models = [points.isel(point=np.flatnonzero(points["kind"] == MODEL)) for points in ahead]
    models = [points for points in models if points.sizes["point"]]
    return f"A cheaper model is the fastest way to some such error on {len(models)} scenes" + (
        f": {_listed(models, quantity)}" if models else ""
    )


def _listed(scenes, quantity):
    return "; ".join(_others(points, quantity) for points in scenes)


def _others(points, quantity):
    """The methods ahead of ours on a scene, with the error and the seconds of each point."""
    told = ", ".join(
        f"{method} {short(error)} in {short(1e3 * seconds)} ms"
        for method, error, seconds in zip(
            points["method"].values, points[quantity].values, points["seconds"].values, strict=True
        )
    )
    return f"{points.attrs['scene']}, {points.attrs['overlapping']} nodes overlapping ({told})"
