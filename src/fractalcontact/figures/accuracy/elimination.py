"""Whether dropping points alone reaches the right contact set, by kernel and by tolerance."""

import numpy as np
from matplotlib.figure import Figure

from ..kit.drawing import COLOURS, LINES, MARKERS, WIDTH, Drawing, entries, group, letter


def draw(atlas, names):
    """Sign of the inverse influence matrix, wrong sets, and what inexact solves lose.

    Parameters
    ----------
    atlas : xr.DataTree
    names : list of str
        Specimens of the study; the scenes here are none of them.

    Returns
    -------
    Drawing
    """
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
    return Drawing(figure, data, _caption(elimination))


def _draw_signs(axes, elimination):
    worst = elimination["largest_off_diagonal"].values
    rows = np.arange(worst.size)
    made = elimination["counter_example"].values == 1
    # The values span decades on both sides of zero.
    axes.set_xscale("symlog", linthresh=1e-5, linscale=0.5)
    axes.axvline(0, color="0.5", lw=0.8)
    for chosen, colour, marker, label in (
        (~made, COLOURS[1], MARKERS[0], "elimination always right"),
        (made, COLOURS[2], MARKERS[1], "a scene made on purpose defeats it"),
    ):
        if chosen.any():
            axes.plot(worst[chosen], rows[chosen], marker, color=colour, label=label)
    axes.set_yticks(rows, [_cased(case) for case in elimination["case"].values])
    axes.set_ylim(rows[-1] + 0.6, -0.6)
    axes.set_xticks([-1e-3, 0, 1e-3, 1e-2], ["$-10^{-3}$", "0", "$10^{-3}$", "$10^{-2}$"])
    axes.set_xlabel("largest entry off the diagonal\nas a share of the diagonal (1)")
    axes.legend(handles=entries(axes), loc="upper center", bbox_to_anchor=(0.3, -0.32))


def _draw_tolerances(axes, elimination):
    tolerance = elimination["tolerance"].values
    for n, (name, label) in enumerate(
        (("lost", "scenes that lose contact nodes"), ("area_error", "largest error of $A_r$"))
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
    axes.set_ylabel("share (1)")
    axes.legend(loc="upper left")


def _caption(elimination):
    tried = int(elimination["tried"].values[0])
    wrong = elimination["wrong"].values
    chance = "; ".join(
        f"{count} of {tried} ({_cased(case)})"
        for case, count in zip(elimination["case"].values, wrong, strict=True)
        if count
    )
    made = elimination["case"].values[elimination["counter_example"].values == 1]
    side = elimination.attrs["window"]
    return (
        "The paper's algorithm (its sect. 4) drops the points in tension and never takes one back. "
        "(a) That is always right where the inverse of the influence matrix has no positive entry "
        f"off its diagonal (here on {side[0]} x {side[1]} nodes): with Love's kernel it has none, "
        "whatever the cells. "
        + (
            f"With {_listed(made)}, readings of the paper's rigid plate, it has, and a scene made "
            "for it ends with a point left interpenetrating. "
            if made.size
            else ""
        )
        + "On random rough scenes it ended on a wrong set in "
        f"{chance or f'none of {tried} a case'}. (b) A loose solve on the way drops nodes that "
        "belong to the contact, and they never come back: scenes in which that happens."
    )


def _cased(case):
    """A kernel's name as it is written: Love's bears a name."""
    return case.replace("love", "Love")


def _listed(names):
    return " and ".join(name.split(",")[0] for name in names)
