"""Errors of area, Delta_sigma and pressure against time on the largest rough test problems."""

from collections.abc import Sequence

from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing
from fractalcontact.figures.kit.titles import letter

from ._speed import (
    AXES,
    draw_points,
    legend_of,
    middle_contact,
    pick,
    rough,
    scenes_of,
    styles,
    table_of,
    values_of,
)
from .error_time import front

TITLE = "Errors of contact area, Delta_sigma and pressure against wall time"
SUBJECT = "study"
NEEDS = ("speed",)
KEY = "speed"
ORDER = 60

QUANTITIES = ("area_error", "delta_error", "pressure_error")


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Rows of quantities, a column for each H, at the largest size and the middle contact."""
    scenes = rough(scenes_of(atlas))
    looks = styles(scenes)
    size, contact = values_of(scenes, "size")[-1], middle_contact(scenes)
    columns = values_of(scenes, "hurst")
    figure = Figure(figsize=(WIDTH, 7.2))
    panels = figure.subplots(
        len(QUANTITIES), len(columns), sharex=True, sharey="row", squeeze=False
    )
    for j, hurst in enumerate(columns):
        scene = pick(scenes, size=size, contact=contact, hurst=hurst)
        for i, quantity in enumerate(QUANTITIES):
            draw_points(panels[i, j], scene, quantity, looks)
            title = rf"$H$ = {hurst:g}, {100 * contact:g} %, {size}$^2$"
            letter(panels[i, j], "abcdefghijkl"[i * len(columns) + j], title)
            panels[i, 0].set_ylabel(AXES[quantity])
        panels[-1, j].set_xlabel("wall time (s)")
    legend_of(figure, panels.flat)
    share = f"{100 * contact:g}"
    words = caption(__name__, size=size, share=share, **front(scenes, "pressure_error"))
    return Drawing(figure, table_of(scenes), words)
