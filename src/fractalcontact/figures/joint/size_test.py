"""The size test: A_r/A_0 over the side b of parts of the window at equal nominal pressure."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing
from ..kit.empty import say_empty
from ..kit.legends import heading, legends_below
from ..kit.sizes import plain_decades
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ._size_exponents import draw_measured, draw_predictions, load_axis, size_legends
from ._size_test import draw_over_side, place_of, rows_of_loads, rows_predicted, shown_loads

TITLE = "Size test: real contact area of parts of the window at equal pressure, beside eq. 6"
SUBJECT = "specimen"
NEEDS = ("size_test", "windows", "statements")
ORDER = 170

#: Exponents at equal sigma_0: name, and what they are of.
_EXPONENTS = ("area_exponent", "compliance_exponent", "gap_exponent")


def draw(atlas: DataTree, name: str) -> Drawing:
    """A_r/A_0 over b at some sigma_0, and its exponent over the load, beside eq. 6's.

    Its data also have the exponents of the compliance and of the mean gap.
    """
    subject = Subject.of(atlas, name)
    test = subject["size_test"]
    loads = shown_loads(test, "area_exponent_low")
    figure = Figure(figsize=(WIDTH, 3.9))
    area, exponents = figure.subplots(1, 2)
    measured = _draw_area(area, test, loads)
    _draw_exponents(exponents, test, loads)
    others, laws = size_legends(exponents)
    legends_below(figure, measured + others, laws)
    headline(figure, subject.label, place_of(test))
    words = caption(
        __name__,
        claim=claim(atlas, name, "size_effect_follows", why=test.attrs["verdict_reason"]),
        measured=bool(np.isfinite(test["area_exponent_low"]).any()),
        effect=bool(test["size_effect"].any()),
    )
    return Drawing(figure, _table(test), words)


def _draw_area(axes, test, loads):
    """A_r/A_0 over b at some sigma_0 with intervals, and eq. 6's prediction; legend entries."""
    handles = draw_over_side(axes, test, "area_fraction", "area_exponent", loads)
    axes.set_ylabel(r"real contact area $A_r/A_0$ (1)")
    letter(axes, "a", "contact area at equal pressure")
    if not len(loads):
        say_empty(axes, "no load at which two sizes\nhold enough nodes", ticks=False)
        return []
    axes.set_yscale("log")
    drawn = test["area_fraction"].values[loads]
    axes.set_ylim(np.nanmin(drawn) / 2.5, np.nanmax(drawn) * 8)
    plain_decades(axes.yaxis)
    return [heading("measured, exponent of $b$ [95 % interval]"), *handles]


def _draw_exponents(axes, test, loads):
    """Exponent of A_r/A_0 over b, and those of eq. 6, over the load."""
    draw_predictions(axes, test, decided=True)
    draw_measured(axes, test, "area_exponent", loads)
    load_axis(axes, test)
    axes.set_ylabel("exponent of $A_r/A_0$ over $b$ (1)")
    none = "" if np.isfinite(test["area_exponent"].values).any() else "; none measured"
    letter(axes, "b", rf"exponent (0: no size effect; eq. 6: $\Delta_\sigma - 2$){none}")


def _table(test):
    means = ("area_fraction", "interface_compliance", "mean_gap")
    exponents = [of for name in _EXPONENTS for of in (name, f"{name}_n")]
    of_sizes = (*means, "side", "min_nodes", "central_load")
    tables = [
        rows_of_loads(test, *of_sizes, panel="a"),
        rows_of_loads(test, *exponents, panel="b"),
        rows_predicted(test),
    ]
    return pd.concat(tables, ignore_index=True)
