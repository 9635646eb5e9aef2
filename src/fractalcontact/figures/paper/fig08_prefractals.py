"""Fig. 8: the contact domain at coarser and coarser resolution, under one load."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...domain.renormalisation import RESOLUTION
from ..kit.domains import Loading, disagreement
from ..kit.drawing import WIDTH, Drawing, headline, letter
from ..kit.maps import draw_domain
from ..kit.verdicts import claim
from ..kit.words import force_label, percent, short

TITLE = "Fig. 8: contact domains of the pre-fractals under one load"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "statements")
ORDER = 130

#: Maps side by side.
_COLUMNS = 4


def draw(atlas: DataTree, name: str) -> Drawing:
    """Contact domains at all resolutions, with A_r and sigma_r = F / A_r."""
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
    falls = claim(atlas, name, "fall of A_r as a power", "area_is_lacunar", numbers=False)
    return Drawing(figure, table, _caption(loading, i, table, falls))


def _table(loading, i):
    """One row a resolution, fine to coarse."""
    scaling = loading.scaling.isel(normal_force=i).sortby(RESOLUTION)
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


def _caption(loading, i, table, falls):
    by_area, by_box = loading.estimates
    return (
        f"{loading.opening('Fig. 8')} Contact domains (black) at {len(table)} resolutions, "
        f"F = {force_label(loading.forces[i])}. {falls} Delta_sigma is {by_area.text(i)} "
        f"by A_r(s), {by_box.text(i)} by box counting ({loading.fit_ranges(i)}). "
        f"{disagreement(loading.scaling.isel(normal_force=i))}"
    )
