"""Elimination: contact sets reached by dropping points alone, by kernel and by tolerance."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import COLOURS, LINES, MARKERS, WIDTH, Drawing, group
from fractalcontact.figures.kit.legends import entries
from fractalcontact.figures.kit.titles import letter

TITLE = "Whether dropping points in tension, as the paper does, reaches the contact set"
SUBJECT = "study"
NEEDS = ("elimination",)
KEY = "stability"
ORDER = 110


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Sign of the inverse influence matrix, wrong sets, and nodes lost by inexact solves."""
    elimination = group(atlas, "elimination", "scenes")
    figure = Figure(figsize=(WIDTH, 3.0))
    left, right = figure.subplots(1, 2, width_ratios=[1.2, 1])
    _draw_signs(left, elimination)
    _draw_tolerances(right, elimination)
    letter(left, "a", "inverse of the influence matrix")
    letter(right, "b", "inexact solves, Love's kernel")
    cases = elimination.drop_dims("tolerance").to_dataframe()
    tolerances = elimination.drop_dims("case").to_dataframe()
    data = cases.reset_index().merge(
        tolerances.reset_index(), how="outer", left_index=True, right_index=True
    )
    return Drawing(figure, data, caption(__name__, **_counts(elimination)))


def _draw_signs(axes, elimination):
    worst = elimination["largest_off_diagonal"].values
    rows = np.arange(worst.size)
    defeated = elimination["counter_example"].values == 1
    # The values span decades on both sides of zero.
    axes.set_xscale("symlog", linthresh=1e-5, linscale=0.5)
    axes.axvline(0, color="0.5", lw=0.8)
    for chosen, colour, marker, label in (
        (~defeated, COLOURS[1], MARKERS[0], "elimination always right"),
        (defeated, COLOURS[2], MARKERS[1], "a counter-example defeats it"),
    ):
        if chosen.any():
            axes.plot(worst[chosen], rows[chosen], marker, color=colour, label=label)
    axes.set_yticks(rows, [_cased(case) for case in elimination["case"].values])
    axes.set_ylim(rows[-1] + 0.6, -0.6)
    axes.set_xticks([-1e-3, 0, 1e-3, 1e-2], ["$-10^{-3}$", "0", "$10^{-3}$", "$10^{-2}$"])
    axes.set_xlabel("largest entry off the diagonal\nover the diagonal (1)")
    axes.legend(handles=entries(axes), loc="upper center", bbox_to_anchor=(0.3, -0.32))


def _draw_tolerances(axes, elimination):
    tolerance = elimination["tolerance"].values
    for n, (name, label) in enumerate(
        (
            ("lost", "problems that lose contact nodes"),
            ("area_error", "largest error of $A_r$"),
        )
    ):
        axes.plot(
            tolerance,
            elimination[name].values,
            marker=MARKERS[n],
            ls=LINES[n],
            color=COLOURS[n + 1],
            label=label,
        )
    axes.set_xscale("log")
    axes.set_xlabel("tolerance of the solves (1)")
    axes.set_ylabel("fraction; error (1)")
    axes.legend(loc="upper left")


def _cased(case):
    """A kernel's name as it is written: Love's bears a name."""
    return case.replace("love", "Love")


def _counts(elimination):
    """Counts of wrong contact sets, and the readings that a proof defeats."""
    tried = int(elimination["tried"].values[0])
    chance = [
        f"{count} of {tried} ({_cased(case)})"
        for case, count in zip(elimination["case"].values, elimination["wrong"].values, strict=True)
        if count
    ]
    defeated = elimination["case"].values[elimination["counter_example"].values == 1]
    readings = [name.split(",")[0] for name in defeated]
    return {"tried": tried, "chance": chance, "defeated": readings}
