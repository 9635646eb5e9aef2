"""Closure, area and strength of the whole window as its parts predict them."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    headline,
    label_short_span,
    legends_below,
    letter,
    settings_of,
)
from ..kit.sizes import nothing_in, plain_decades
from ..kit.words import SUPPLEMENTARY, percent, short
from ._size_test import grey_beyond, load_columns, place_of, size_test_of

TITLE = "Closure and contact area of the whole window, predicted from its parts"
SUBJECT = "specimen"
NEEDS = ("size_test", "windows")
ORDER = 172

PREDICTORS = {
    "power_law": "power law of small parts",
    "eq6_area": "eq. 6, $A_r(s)$",
    "eq6_box": "eq. 6, box counting",
    "eq6_box_sizes": "eq. 6, occupied windows",
    "no_size_effect": "no size effect",
}
_QUANTITIES = {
    "closure": ("normal_force", r"closure $w_\mathrm{int}$"),
    "area": ("normal_force", "$A_r/A_0$"),
    "strength": ("dilatancy_load", r"strength $\tau$"),
}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Predicted over solved values of the whole window, by every predictor.

    Its data also have the strength.
    """
    test = size_test_of(atlas, name)
    figure = Figure(figsize=(WIDTH, 3.7))
    panels = figure.subplots(1, 2)
    for axes, which, quantity in zip(panels, "ab", ("closure", "area"), strict=True):
        _draw_errors(axes, test, quantity, which)
    handles = entries(panels[0])
    # First those of this window, then eq. 6's.
    legends_below(figure, handles[::4] + handles[5:], handles[1:3], handles[3:4])
    headline(figure, settings_of(atlas, name)["label"], place_of(test))
    return Drawing(figure, _table(test), _caption(test))


def _draw_errors(axes, test, quantity, which):
    """Predicted over solved values of the whole window."""
    words = _QUANTITIES[quantity][1]
    pressure = test["nominal_pressure"].values
    drawn = False
    for i, (predictor, label) in enumerate(PREDICTORS.items()):
        ratio = 1 + test[f"{quantity}_error"].sel(predictor=predictor).values
        known = np.isfinite(ratio)
        drawn |= known.any()
        style = {"color": colour_of(i), "marker": MARKERS[i], "ms": 3}
        axes.plot(pressure[known], ratio[known], lw=0.8, label=label, **style)
    axes.axhline(1, color="0.5", lw=0.6)
    grey_beyond(axes, test)
    axes.set_xlabel(r"$\sigma_0$ of the whole window (MPa)")
    axes.set_ylabel(f"{words}: predicted / solved (1)")
    letter(axes, which, f"{words} (1: right)")
    if not drawn:
        # Without data a logarithmic axis has no limits.
        nothing_in(axes, "nothing to predict from")
        return
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, 0.5), max(high, 2))
    shown = pressure[np.isfinite(test[f"{quantity}_error"]).any("predictor").values]
    axes.set_xlim(shown[0] / 1.3, shown[-1] * 1.3)
    plain_decades(axes.yaxis)
    label_short_span(axes.xaxis)


def _table(test):
    tables = [pd.DataFrame({"quantity": [], "load_N": [], "predictor": []})]
    for quantity, (dim, _) in _QUANTITIES.items():
        if f"direct_{quantity}" not in test:
            continue
        for j, force in enumerate(test[dim].values):
            columns = {
                "quantity": f"predicted_{quantity}",
                **load_columns(test, force),
                "predictor": test["predictor"].values,
            }
            columns |= {
                f"predicted{end}": test[f"predicted_{quantity}{end}"].values[:, j]
                for end in ("", "_low", "_high")
            }
            columns["solved"] = float(test[f"direct_{quantity}"][j])
            columns["unit"] = test[f"direct_{quantity}"].attrs["units"]
            tables.append(pd.DataFrame(columns))
    return pd.concat(tables[1:] or tables, ignore_index=True)


def _caption(test):
    words = f"{SUPPLEMENTARY} What parts of the window predict of the whole, over what was solved."
    errors = abs(test[["closure_error", "area_error"]].sel(predictor=list(PREDICTORS)))
    known = np.isfinite(errors.to_dataarray()).all(("variable", "predictor")).values
    of_study = known & ~test["beyond_study"].values.astype(bool)
    if not known.any():
        return f"{words} No load lets all of them predict closure and contact area."
    # The heaviest load of the study says most: more nodes touch. One beyond it matters to nobody.
    load = np.flatnonzero(of_study if of_study.any() else known)[-1]
    beyond = "" if of_study.any() else ", beyond the study's loads,"
    here = errors.isel(normal_force=load)
    pressure = short(float(test["nominal_pressure"][load]))
    closure, area = (_range_words(here[f"{name}_error"]) for name in ("closure", "area"))
    return f"{words} At {pressure} MPa{beyond} closure is off by {closure}, contact area by {area}."


def _range_words(errors):
    """Least and largest error, each with its predictor."""
    ends = (int(errors.values.argmin()), int(errors.values.argmax()))
    names = [PREDICTORS[key].replace("$", "") for key in errors["predictor"].values]
    return " to ".join(f"{percent(float(errors[i]))} ({names[i]})" for i in dict.fromkeys(ends))
