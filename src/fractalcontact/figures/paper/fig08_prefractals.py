"""Fig. 8: the contact domain at coarser and coarser resolution, under one load."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ...domain.renormalisation import RESOLUTION
from ..kit.domains import Loading, disagreement
from ..kit.drawing import WIDTH, Drawing, headline, letter
from ..kit.maps import draw_domain
from ..kit.words import force_label, percent, short

#: Maps side by side.
_COLUMNS = 4


def draw(atlas, name):
    """Contact domains at all resolutions, with A_r and sigma_r = F / A_r.

    Parameters
    ----------
    atlas : xr.DataTree
    name : str
        The specimen.

    Returns
    -------
    Drawing
    """
    loading = Loading.of(atlas, name)
    i = loading.map_load
    table = _table(loading, i)
    rows, columns = -(-len(table) // _COLUMNS), min(len(table), _COLUMNS)
    aspect = loading.sides[0] / loading.sides[1]
    height = rows * (WIDTH / _COLUMNS * aspect + 0.75)
    figure = Figure(figsize=(WIDTH, height + 0.3))
    panels = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    for axes, which, row in zip(panels, "abcdefghijklmnop", table.itertuples(), strict=False):
        draw_domain(axes, loading.domain(row.resolution, i), loading.sides)
        letter(
            axes,
            which,
            f"$s$ = {short(row.spacing_mm)} mm\n"
            f"$A_r$ = {short(row.area_mm2)} mm$^2$\n"
            f"$A_r/A_0$ = {percent(row.area_share)}\n"
            rf"$\sigma_r$ = {short(row.sigma_r_MPa)} MPa",
        )
        axes.label_outer()
    for axes in panels[len(table) :]:
        axes.remove()
    headline(figure, *loading.title, f"$F$ = {force_label(loading.forces[i])}")
    return Drawing(figure, table, _caption(loading, i, table))


def _table(loading, i):
    """One row a resolution, fine to coarse."""
    scaling = loading.scaling.isel(load=i).sortby(RESOLUTION)
    area = scaling["area"].values
    force = loading.forces[i]
    return pd.DataFrame(
        {
            "load_N": force,
            "offset_mm": loading.offset,
            "resolution": scaling[RESOLUTION].values,
            "spacing_mm": scaling["spacing"].values,
            "area_mm2": area,
            "area_share": area / np.prod(loading.sides),
            "sigma_r_MPa": force / area,
        }
    )


def _caption(loading, i, table):
    by_area, by_box = loading.estimates
    return (
        f"{loading.opening('Fig. 8')} Contact domains (black) under "
        f"F = {force_label(loading.forces[i])}; resolutions: {len(table)}. {_verdict(table)} "
        f"Delta_sigma [95 % interval] by A_r(s): {by_area.text(i)}; by box counting at the finest "
        f"resolution: {by_box.text(i)} ({loading.fit_ranges(i)}). "
        f"{disagreement(loading.scaling.isel(load=i))}"
    )


def _verdict(table):
    """Whether A_r falls, and sigma_r rises, as the resolution is refined."""
    area, spacing = table["area_mm2"].values, table["spacing_mm"].values
    if len(table) < 2:
        return "With one resolution there is nothing to compare."
    refined = (
        f"from {short(area[-1])} mm2 at s = {short(spacing[-1])} mm to {short(area[0])} mm2 at "
        f"s = {short(spacing[0])} mm"
    )
    if (np.diff(area) > 0).all():
        return f"As in the paper, A_r falls with every refinement, {refined}, and sigma_r rises."
    return (
        f"Unlike in the paper, A_r goes {refined} without falling at every refinement "
        f"({(np.diff(area) > 0).sum()} of {len(area) - 1})."
    )
