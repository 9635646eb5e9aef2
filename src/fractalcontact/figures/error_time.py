"""Error of the force against time on the rough scenes, with the Pareto front."""

from matplotlib.figure import Figure

from ..speed import LEADS_BELOW, OURS, ahead_of_ours
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
from ._words import short
from .common import WIDTH, Drawing, letter

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
    behind = {
        scene.attrs["scene"]: points
        for scene in scenes.values()
        if (points := ahead_of_ours(scene, quantity=quantity)).sizes["point"]
    }
    lead = [scene.attrs["scene"] for scene in scenes.values()]
    lead = [name for name in lead if name not in behind]
    runs = int(max(scene["runs"].max() for scene in scenes.values()))
    opening = (
        f"In no figure of the paper: error of the {words} against wall time on self-affine "
        f"surfaces pressed by a closure from a cold start, medians of up to {runs} runs taken in "
        f"turn, {next(iter(scenes.values())).attrs['threads']} thread(s) of ours. "
        f"{OURS} is on the Pareto front at every error below {LEADS_BELOW:g} on "
        f"{len(lead)} of {len(scenes)} scenes (nodes a side, H, share in contact)"
    )
    told = [f"{name} ({_others(points, quantity)})" for name, points in behind.items()]
    parts = [opening + (f": {'; '.join(lead)}." if lead else ".")]
    if told:
        parts.append(f"Not on: {'; '.join(told)}, where others are faster to the errors named.")
    worst = max(scene.attrs["reference_error"] for scene in scenes.values())
    parts.append(f"The references' own error of the force is at most {short(worst)}.")
    return " ".join(parts)


def _others(points, quantity):
    """Methods ahead of ours, with the error and the seconds of each point."""
    told = []
    for i in range(points.sizes["point"]):
        one = points.isel(point=i)
        told.append(
            f"{one['method'].item()} {short(one[quantity])} in {short(1e3 * one['seconds'])} ms"
        )
    return ", ".join(told)
