"""Closure, area and strength of the whole window as its parts predict them."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ..kit.axes import label_short_span
from ..kit.caption import caption
from ..kit.drawing import MARKERS, WIDTH, Drawing, colour_of
from ..kit.empty import say_empty
from ..kit.legends import entries, legends_below
from ..kit.sizes import plain_decades
from ..kit.titles import headline, letter
from ..kit.words import short
from ._prediction_words import PREDICTORS, caption_values, ends_words
from ._size_test import grey_beyond, place_of, rows_of_loads

TITLE = "Closure and contact area of the whole window, predicted from its parts"
SUBJECT = "specimen"
NEEDS = ("size_test", "windows")
ORDER = 172

_QUANTITIES = {"closure": r"closure $w_\mathrm{int}$", "area": "contact area $A_r/A_0$"}

#: What the bars at the load of the caption are, and how far they stand apart.
_BARS = "95 % intervals there, side by side"
_BESIDE = 1.06


def draw(atlas: DataTree, name: str) -> Drawing:
    """Predicted over solved values of the whole window, by every predictor.

    Its data also have the strength.
    """
    subject = Subject.of(atlas, name)
    test = subject["size_test"]
    figure = Figure(figsize=(WIDTH, 3.7))
    panels = figure.subplots(1, 2)
    quoted = np.flatnonzero(test["quoted_load"].values)
    load = int(quoted[0]) if quoted.size else None
    for axes, which, quantity in zip(panels, "ab", ("closure", "area"), strict=True):
        _draw_errors(axes, test, quantity, which, load)
    handles = entries(panels[0])
    # First those of this window, then eq. 6's, then all else.
    columns = handles[:5:4], handles[1:4], handles[5:]
    legends_below(figure, *columns, columnspacing=3)
    headline(figure, subject.label, place_of(test))
    table = _table(test, subject["windows"])
    return Drawing(figure, table, caption(__name__, **caption_values(test, load)))


def _draw_errors(axes, test, quantity, which, load):
    """Predicted over solved values of the whole window."""
    words = _QUANTITIES[quantity]
    pressure = test["nominal_pressure"].values
    drawn = False
    closure, area = (test[f"{name}_error"] for name in ("closure", "area"))
    for i, (predictor, label) in enumerate(PREDICTORS.items()):
        if not any(np.isfinite(one.sel(predictor=predictor)).any() for one in (closure, area)):
            label = f"{label} (not known here)"
        ratio = 1 + test[f"{quantity}_error"].sel(predictor=predictor).values
        known = np.isfinite(ratio)
        drawn |= known.any()
        style = {"color": colour_of(i), "marker": MARKERS[i], "ms": 3}
        if predictor == "eq6_box_sizes":
            # Where eq. 6 has no size effect, what stands for that hides it.
            style |= {"ms": 5.5, "mfc": "white"}
        axes.plot(pressure[known], ratio[known], lw=0.8, label=label, **style)
        if load is not None:
            solved = float(test[f"direct_{quantity}"][load])
            ends = (test[f"predicted_{quantity}_{end}"] for end in ("low", "high"))
            low, high = (float(end.sel(predictor=predictor)[load]) / solved for end in ends)
            if np.isfinite([low, high]).all():
                at = pressure[load] * _BESIDE ** (i - 2)
                axes.vlines(at, max(low, 1e-3), high, color=style["color"], lw=0.8)
    axes.axhline(1, color="0.5", lw=0.6)
    if load is not None:
        axes.axvline(
            pressure[load], color="0.4", ls=":", lw=0.8, label=f"{short(float(pressure[load]))} MPa"
        )
        axes.plot([], [], color="0.4", lw=0.8, marker="|", ls="none", ms=8, label=_BARS)
    grey_beyond(axes, test)
    axes.set_xlabel(r"nominal pressure $\sigma_0$ of the whole window (MPa)")
    axes.set_ylabel(f"{words}: predicted / solved (1)")
    at = "" if load is None else ends_words(test, quantity, load)
    letter(axes, which, f"{words} (1: as solved){at}")
    if not drawn:
        # Without data a logarithmic axis has no limits.
        say_empty(axes, "nothing to predict from", ticks=False)
        return
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, 0.5), max(high, 2))
    shown = pressure[np.isfinite(test[f"{quantity}_error"]).any("predictor").values]
    axes.set_xlim(shown[0] / 1.3, shown[-1] * 1.3)
    plain_decades(axes.yaxis)
    label_short_span(axes.xaxis)


def _table(test, laws):
    """Predictions for the whole window beside the solved values; strength where it slides."""
    tables = [
        rows_of_loads(test, f"predicted_{name}", f"direct_{name}", quantity=name)
        for name in _QUANTITIES
    ]
    if "predicted_strength" in laws:
        strength = laws.drop_dims("normal_force").drop_vars("nominal_pressure", errors="ignore")
        strength = strength.rename(dilatancy_load="normal_force")
        of_study = test["beyond_study"].sel(
            normal_force=strength["normal_force"].values, method="nearest"
        )
        of_study = of_study.assign_coords(normal_force=strength["normal_force"])
        strength = strength.assign(beyond_study=of_study)
        columns = ("predicted_strength", "direct_strength")
        tables.append(rows_of_loads(strength, *columns, quantity="strength"))
    return pd.concat(tables, ignore_index=True)
