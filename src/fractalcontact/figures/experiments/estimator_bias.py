"""Bias and coverage of the estimators of Delta_g on synthetic surfaces of known H."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import LINES, MARKERS, WIDTH, Drawing, colour_of, entries, group, letter
from ..kit.words import SUPPLEMENTARY

TITLE = "Bias, scatter and coverage of the estimators of the surface dimension"
SUBJECT = "study"
NEEDS = ("estimator_bias",)
KEY = "estimator_bias"
ORDER = 40

#: Bias that three estimators at least are to keep to where H is 0.5 or more.
TOLERATED = 0.03
#: Fraction of the intervals that are to hold H there.
PROMISED = 0.9


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Bias with scatter, and coverage, by H, size, roll-off and estimator."""
    bias = group(atlas, "estimator_bias", "surfaces")
    sizes, roll_offs = bias["size"].values, bias["roll_off"].values
    figure = Figure(figsize=(WIDTH, 0.8 + 4.8 * len(sizes)))
    panels = figure.subplots(
        2 * len(sizes),
        len(roll_offs),
        sharex=True,
        sharey="row",
        squeeze=False,
        height_ratios=[1.6, 1] * len(sizes),
    )
    letters = iter("abcdefghijklmnopqrstuvwxyz")
    for row, size in enumerate(sizes):
        of_size = list(enumerate(roll_offs))
        for column, roll_off in of_size:
            panel = panels[2 * row, column]
            _draw_bias(panel, bias.sel(size=size, roll_off=roll_off))
            letter(panel, next(letters), f"bias, {_surface_words(size, roll_off)}")
        for column, roll_off in of_size:
            panel = panels[2 * row + 1, column]
            _draw_coverage(panel, bias.sel(size=size, roll_off=roll_off))
            letter(panel, next(letters), "intervals that hold $H$")
        panels[2 * row, 0].set_ylabel("estimated less true $H$ (1)")
        panels[2 * row + 1, 0].set_ylabel("fraction of surfaces (1)")
    places = np.arange(bias.sizes["hurst"])
    for panel in panels[-1]:
        panel.set_xticks(places, [f"{hurst:g}" for hurst in bias["hurst"].values])
        panel.set_xlabel("Hurst exponent $H$ of the surfaces (1)")
    figure.legend(handles=entries(panels[0, 0]), loc="outside lower center", ncols=4)
    figure.suptitle(
        f"{bias.sizes['seed']} synthetic surfaces each: mean, with the standard deviation between "
        "surfaces\nhollow: before known bias is taken off",
        fontsize=9,
    )
    return Drawing(figure, _table(bias), _caption(bias))


def _surface_words(size, roll_off):
    """Surfaces of one panel: nodes and roll-off."""
    if not np.isfinite(roll_off):
        return rf"{size}$^2$ nodes, no roll-off"
    return rf"{size}$^2$, roll-off at {roll_off:.3g} $b$"


def _beside(bias, n):
    """Places of the n-th estimator's points, beside those of the others."""
    step = 0.8 / bias.sizes["estimator"]
    return np.arange(bias.sizes["hurst"]) + (n - (bias.sizes["estimator"] - 1) / 2) * step


def _draw_bias(axes, bias):
    axes.axhspan(-TOLERATED, TOLERATED, color="0.9", lw=0, label=f"within {TOLERATED:g}")
    axes.axhline(0, color="0.5", lw=0.6)
    for n, name in enumerate(bias["estimator"].values):
        one, x = bias.sel(estimator=name), _beside(bias, n)
        style = {"color": colour_of(n), "marker": MARKERS[n % len(MARKERS)], "ls": "none"}
        label = name.replace("_", " ")
        axes.errorbar(x, one["bias"], one["scatter"], capsize=2, lw=0.8, label=label, **style)
        moved = np.abs(one["slope_bias"] - one["bias"]) > 1e-9
        axes.plot(x[moved], one["slope_bias"][moved], mfc="none", mew=0.7, alpha=0.8, **style)
    _separate(axes, bias)


def _draw_coverage(axes, bias):
    axes.axhline(PROMISED, color="0.5", lw=0.8, ls=LINES[1])
    for n, name in enumerate(bias["estimator"].values):
        axes.plot(
            _beside(bias, n),
            bias["coverage"].sel(estimator=name),
            color=colour_of(n),
            marker=MARKERS[n % len(MARKERS)],
            ls="none",
        )
    axes.set_ylim(-0.05, 1.05)
    _separate(axes, bias)


def _separate(axes, bias):
    """Lines between the values of H."""
    for place in np.arange(1, bias.sizes["hurst"]) - 0.5:
        axes.axvline(place, color="0.85", lw=0.6)
    axes.set_xlim(-0.5, bias.sizes["hurst"] - 0.5)


def _table(bias):
    """One row an estimator, H and size."""
    columns = [
        "bias",
        "bias_low",
        "bias_high",
        "slope_bias",
        "scatter",
        "rms_error",
        "half_width",
        "coverage",
    ]
    return bias[columns].to_dataframe().reset_index()


def _caption(bias):
    start = bias.attrs["from_hurst"]
    opening = (
        f"{SUPPLEMENTARY} Bias and coverage of the estimators of Delta_g = 3 - H on "
        f"{bias.sizes['seed']} synthetic surfaces of each kind."
    )
    known = bias.sel(estimator=bias["worst_bias"].notnull())
    if not known.sizes["estimator"]:
        return f"{opening} No H of {start:g} or more is among them."
    errors = known["overall_error"].to_series()
    least = known["least_coverage"].to_series()
    name = bias.attrs["recommended"]
    return (
        f"{opening} From H = {start:g}, {_name(name)} (recommended) has an rms error of "
        f"{errors[name]:.3f}, {_place(errors, name)}; its intervals hold H in "
        f"{_at_least(least[name])}, those of the worst estimator in "
        f"{100 * least.min():.0f} %.{_rough_words(bias, start)}"
    )


def _at_least(share):
    """A share that is the least of several, in percent."""
    return "100 %" if share >= 0.995 else f"{100 * share:.0f} % or more"


def _place(errors, name):
    """Which of all rms errors one is."""
    rank = int((errors < errors[name]).sum())
    return "the least" if rank == 0 else f"{_name(errors.idxmin())} {errors.min():.3f}"


def _name(estimator):
    """An estimator in words."""
    return str(estimator).replace("_", " ")


def _rough_words(bias, start):
    """The warning where intervals hold H less often than promised on rougher surfaces."""
    rough = bias["coverage"].where(bias["hurst"] < start)
    if not bool(rough.notnull().any()):
        return ""
    lowest = rough.min(["hurst", "size", "roll_off"])
    failing = int((lowest < PROMISED).sum())
    if not failing:
        return f" On rougher surfaces they reach {100 * PROMISED:.0f} % too."
    return f" On rougher surfaces {failing} fall to {100 * float(rough.min()):.0f} %."
