"""The decision on eq. 6 at a glance: exponent of the contact area over the size, and prediction."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import heading, legends_below, mark
from fractalcontact.figures.kit.panel import Panel, rows
from fractalcontact.figures.kit.points import reach

from ...experiments.size_decision import NO_EFFECT, PROBABILITY, REFUTED, UPHELD

TITLE = "Size effect of the contact area on synthetic surfaces: measured against eq. 6"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 5

#: Arms that vary the size, in words.
_ARMS = {
    "S1": "surfaces of several sides $b$, roll-off length fixed",
    "S2": "roll-off in proportion to the side $b$",
    "S3": "surfaces without a roll-off",
    "W": "windows of surfaces without a roll-off",
}
#: Estimators of Delta_sigma: name, words, filled.
_ESTIMATORS = (("area", "$A_r(s)$", True), ("box", "box counts", False))
#: Columns of the table for every class, load and estimator.
_COLUMNS = (
    *("alpha", "eq6_exponent", "central_alpha", "theory_alpha", "verdict"),
    "no_size_effect",
)


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Alpha of every class and load against the prediction of eq. 6 by both estimators."""
    test = atlas["size_effect/surfaces"].to_dataset()
    arms = test["arm"].values
    columns = min(len(arms), 2)
    lines = -(-len(arms) // columns)
    figure = Figure(figsize=(WIDTH, 1.1 + 3 * lines))
    panels = figure.subplots(lines, columns, sharey=True, squeeze=False)
    for axes in panels.ravel()[len(arms) :]:
        axes.remove()
    for which, axes, arm in zip("abcd", panels.ravel(), arms, strict=False):
        Panel(axes, which if len(arms) > 1 else "", _ARMS[str(arm)])
        _draw_arm(axes, test.sel(arm=arm))
        axes.set_xlabel(r"exponent wanted by eq. 6: $-(2-\Delta_\sigma)$ (1)")
    for axes in panels[:, 0]:
        axes.set_ylabel(r"exponent found: $\alpha=\mathrm{d}\ln(A_r/A_0)/\mathrm{d}\ln b$ (1)")
    legends_below(figure, *_legends(test))
    classes = test["overall"]
    words = caption(
        __name__,
        classes=classes.size,
        refuted=int((classes == REFUTED).sum()),
        supported=int((classes == UPHELD).sum()),
        largest=float(np.nanmax(abs(test["alpha"].values))),
    )
    return Drawing(figure, rows(test, *_COLUMNS), words)


def _draw_arm(axes: Axes, test: xr.Dataset) -> None:
    """Points of one arm: colours are Hurst exponents, markers loads, hollow ones box counts."""
    axes.axhspan(-NO_EFFECT, NO_EFFECT, color="0.88", lw=0, zorder=0)
    axes.axline((0, 0), slope=1, color="k", lw=1.2, ls="--")
    places = product(range(test.sizes["hurst"]), range(test.sizes["reduced_pressure"]), _ESTIMATORS)
    for i, k, (estimator, _, filled) in places:
        of_class = test.isel(hurst=i, reduced_pressure=k).sel(delta_estimator=estimator)
        measured, wanted = (Estimate.read(of_class, name) for name in ("alpha", "eq6_exponent"))
        if measured.known and wanted.known:
            colour = colour_of(i)
            style: dict[str, Any] = {
                "color": colour,
                "mfc": colour if filled else "white",
                "elinewidth": 0.7,
            }
            style |= {"xerr": reach(*wanted.ends), "yerr": reach(*measured.ends)}
            axes.errorbar(wanted.value, measured.value, fmt=MARKERS[k], **style)


def _legends(test: xr.Dataset) -> list[list[Artist]]:
    """Columns of the legend: classes, loads, estimators and lines."""
    classes: list[Artist] = []
    for i, hurst in enumerate(test["hurst"].values):
        # The legend entry of a class names the verdict on eq. 6 if all arms agree.
        decided = np.unique(test["overall"].sel(hurst=hurst).values)
        words = f": {decided[0]}" if len(decided) == 1 else ""
        label = f"$H$ = {hurst:g}{words}"
        classes.append(mark(color=colour_of(i), marker="o", ls="none", label=label))
    loads = [
        mark(color="0.3", marker=MARKERS[i], ls="none", label=f"{load:g}")
        for i, load in enumerate(test["reduced_pressure"].values)
    ]
    estimators = [
        mark(
            color="0.3",
            marker="o",
            ls="none",
            mfc="0.3" if filled else "white",
            label=r"$\Delta_\sigma$ by " + words,
        )
        for _, words, filled in _ESTIMATORS
    ]
    lines = [
        mark(color="k", lw=1.2, ls="--", label="eq. 6 would lie here"),
        Patch(color="0.88", label=rf"no size effect: $|\alpha|$ < {NO_EFFECT:g}"),
    ]
    bars = heading(f"bars: {100 * PROBABILITY:.0f} % intervals")
    head = heading(r"pressure $p/(E^*h′_\mathrm{rms})$")
    return [[*classes, bars], [head, *loads], [*estimators, *lines]]
