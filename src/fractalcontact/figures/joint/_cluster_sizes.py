"""Sizes of the clusters of contact with their laws: a panel of the figure of clusters."""

from typing import Any

import xarray as xr

from ...core.estimate import EXPONENT, Estimate
from ...core.text import compact
from .. import kit

#: Colours and markers of the offsets; the loads have the others.
_OFFSET_COLOURS = (kit.COLOURS[3], kit.COLOURS[4], kit.COLOURS[5])
_OFFSET_MARKERS = ("D", "v", "P")
_SIZES = ("cluster_area", "clusters_at_least", "cluster_law_count", "cluster_law_followed")
_FIT = ("cluster_exponent", *(f"cluster_fit_{key}" for key in ("min", "max", "n", "distance")))


def draw_sizes(panel: kit.Panel, sizes: xr.Dataset) -> None:
    """Clusters of some area or more, with the laws fitted to them."""
    axes = panel.axes
    for n, offset in enumerate(sizes["offset"].values):
        domain = sizes.isel(offset=n)
        domain = domain.isel(octave=(domain["clusters_at_least"] > 0).values)
        panel.keep(domain, *_SIZES, *_FIT)
        exponent = Estimate.read(domain, "cluster_exponent", scale=EXPONENT)
        words = rf"$\beta$ = {exponent.text()}" if exponent.known else "too few for a law"
        if exponent.known and not bool(domain["cluster_law_followed"]):
            words += ", not followed"
        style: dict[str, Any] = {
            "color": _OFFSET_COLOURS[n],
            "marker": _OFFSET_MARKERS[n],
            "ls": "none",
        }
        area, label = domain["cluster_area"], f"$v$ = {compact(offset)} mm: {words}"
        axes.plot(area, domain["clusters_at_least"], label=label, **style)
        axes.plot(area, domain["cluster_law_count"], color=style["color"], lw=0.8)
    axes.set(xscale="log", yscale="log", xlabel="cluster area $a$ (mm$^2$)")
    axes.set_ylim(bottom=0.7)
    axes.set_ylabel(r"number of clusters of area $\geq a$ (1)")
    if sizes["cluster_exponent"].notnull().any():
        axes.plot([], [], color="0.4", lw=0.8, label="lines: laws over the areas fitted")


def size_laws(sizes: xr.Dataset) -> dict[str, Any]:
    """Exponents of the sizes of clusters in words, and the offsets where sizes follow no law."""
    fitted = sizes.isel(offset=sizes["cluster_exponent"].notnull().values)
    exponents = Estimate.read(fitted, "cluster_exponent", scale=EXPONENT)
    if exponents.value.size < 2:
        words = exponents[0].text() if exponents.value.size else ""
    else:
        words = f"{compact(exponents.value.min())} to {compact(exponents.value.max())}"
    broken = fitted["offset"].values[~fitted["cluster_law_followed"].values]
    return {"exponents": words, "broken": [compact(v) for v in broken]}
