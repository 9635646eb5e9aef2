"""Closure and contact area of the whole window as its parts predict them."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from .. import kit
from .size_test import grey_beyond

TITLE = "Closure and contact area of the whole window, predicted from its parts"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "size_test")
ORDER = 172

#: Predictors in the order of their colours, in words.
PREDICTORS = {
    "power_law": "power law of small parts",
    "eq6_area": "eq. 6, $A_r(s)$",
    "eq6_box": "eq. 6, box counting",
    "eq6_box_sizes": "eq. 6, occupied windows",
    "no_size_effect": "no size effect",
}
_QUANTITIES = {"closure": r"closure $w_\mathrm{int}$", "area": "contact area $A_r/A_0$"}


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Predicted over solved values of the whole window, by every predictor."""
    subject = Subject.of(atlas, name)
    test = subject["size_test"].sel(predictor=list(PREDICTORS))
    figure = Figure(figsize=(kit.WIDTH, 3.6))
    titles = [f"{words} (1: as solved)" for words in _QUANTITIES.values()]
    panels = kit.panels_of(figure.subplots(1, 2), titles)
    for panel, quantity in zip(panels, _QUANTITIES, strict=True):
        _draw_ratios(panel, test, quantity)
    handles = panels[0].entries
    kit.legends_below(figure, handles[:3], handles[3:], columnspacing=3)
    kit.headline(
        figure, subject.label, kit.place(str(test["direction"].values), float(test["offset"]))
    )
    return kit.Drawing(figure, kit.table_of(*panels), kit.caption(__name__, **_words(test)))


def _draw_ratios(panel: kit.Panel, test: xr.Dataset, quantity: str) -> None:
    """Predicted over solved values of the whole window."""
    axes, ends = panel.axes, ("", "_low", "_high")
    solved = test[f"direct_{quantity}"]
    ratios = {f"ratio{end}": test[f"predicted_{quantity}{end}"] / solved for end in ends}
    loads = ratios["ratio"].notnull().any("predictor").values
    shown = test.assign(ratios).isel(normal_force=loads)
    kept = (f"predicted_{quantity}", f"direct_{quantity}", "beyond_study")
    for n, (predictor, words) in enumerate(PREDICTORS.items()):
        # The predictors stand side by side, because all have the same loads.
        style: dict[str, Any] = {"unit": (1.04 ** (2 - n), 1.0), "ls": "-", "lw": 0.8, "ms": 3}
        style |= {"color": kit.colour_of(n), "marker": kit.MARKERS[n], "label": words, "keep": kept}
        panel.curve(shown.sel(predictor=predictor), "nominal_pressure", "ratio", **style)
    axes.axhline(1, color="0.5", lw=0.6)
    axes.set_xlabel(r"nominal pressure $\sigma_0$ of the whole window (MPa)")
    axes.set_ylabel(f"{_QUANTITIES[quantity]}: predicted / solved (1)")
    if not loads.any():
        kit.say_empty(axes, "nothing to predict from", ticks=False)
        return
    grey_beyond(axes, shown)
    axes.set(xscale="log", yscale="log")
    low, high = (float(end(shown["ratio"])) for end in (np.nanmin, np.nanmax))
    axes.set_ylim(min(low / 1.5, 0.5), max(1.5 * high, 2))
    kit.plain_decades(axes.yaxis)


def _words(test: xr.Dataset) -> dict[str, Any]:
    """Values of the caption: ranges over the predictors under the load quoted."""
    quoted = np.flatnonzero(test["quoted_load"].values)
    if not quoted.size:
        return {"found": {}}
    quoted_state = test.isel(normal_force=quoted[0])
    names = {"closure": "closure", "contact area": "area"}
    ratios = {words: 1 + quoted_state[f"{name}_error"] for words, name in names.items()}
    return {
        "pressure": float(quoted_state["nominal_pressure"]),
        "beyond": bool(quoted_state["beyond_study"]),
        "found": {words: [float(one.min()), float(one.max())] for words, one in ratios.items()},
    }
