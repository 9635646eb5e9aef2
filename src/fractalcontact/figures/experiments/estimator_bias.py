"""Bias and coverage of the estimators of Delta_g on synthetic surfaces of known H."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import LINES, MARKERS, WIDTH, Drawing, colour_of, entries, group, letter
from ..kit.words import number, supplementary

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
    """Bias with scatter, and coverage, by H, size and estimator."""
    bias = group(atlas, "estimator_bias", "surfaces")
    sizes = bias["size"].values
    figure = Figure(figsize=(WIDTH, 5.6))
    panels = figure.subplots(
        2, len(sizes), sharex=True, sharey="row", squeeze=False, height_ratios=[1.6, 1]
    )
    for column, size in enumerate(sizes):
        chosen = bias.sel(size=size)
        upper, lower = panels[:, column]
        _draw_bias(upper, chosen)
        _draw_coverage(lower, chosen)
        places = np.arange(bias.sizes["hurst"])
        lower.set_xticks(places, [f"{hurst:g}" for hurst in bias["hurst"].values])
        lower.set_xlabel("Hurst exponent $H$ of the surfaces (1)")
        letter(upper, "abcdefgh"[column], rf"bias, {size} $\times$ {size} nodes")
        letter(lower, "abcdefgh"[len(sizes) + column], "intervals that hold $H$")
    panels[0, 0].set_ylabel("estimated less true $H$ (1)")
    panels[1, 0].set_ylabel("fraction of surfaces (1)")
    figure.legend(handles=entries(panels[0, 0]), loc="outside lower center", ncols=4)
    figure.suptitle(
        f"{bias.sizes['seed']} synthetic surfaces each: mean, with the standard deviation between "
        "surfaces\nhollow: before known bias is taken off",
        fontsize=9,
    )
    return Drawing(figure, _table(bias), _caption(bias))


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
        "half_width",
        "coverage",
    ]
    return bias[columns].to_dataframe().reset_index()


def _caption(bias):
    start, first, part = (bias.attrs[key] for key in ("from_hurst", "first_cells", "last_part"))
    opening = (
        f"{supplementary()} Estimators of Delta_g = 3 - H on {bias.sizes['seed']} synthetic "
        f"surfaces of each H and size, fitted over lags from {first:g} cells to {number(part, 3)} "
        "of the side."
    )
    known = bias.sel(estimator=bias["worst_bias"].notnull())
    if not known.sizes["estimator"]:
        return f"{opening} No H of {start:g} or more is among them."
    worst = known["worst_bias"]
    good = _names(worst["estimator"][worst <= TOLERATED].values)
    verdict = f"{len(good)} of {worst.size} keep their bias within {TOLERATED:g}"
    verdict += f" ({', '.join(good)})" if good else ""
    least = float(known["coverage"].where(bias["hurst"] >= start).min())
    return (
        f"{opening} For H of {start:g} or more {verdict}; 95 % intervals hold H in "
        f"{100 * float(known['mean_coverage'].mean()):.0f} % of all surfaces, in "
        f"{100 * least:.0f} % of any H, size and estimator.{_rough_words(bias, start)}"
    )


def _names(estimators):
    """Estimators in words."""
    return [str(name).replace("_", " ") for name in estimators]


def _rough_words(bias, start):
    """The warning where intervals hold H less often than promised on rougher surfaces."""
    rough = bias["coverage"].where(bias["hurst"] < start)
    if not bool(rough.notnull().any()):
        return ""
    lowest = rough.min(["hurst", "size"])
    failing = int((lowest < PROMISED).sum())
    if not failing:
        return f" On rougher surfaces they reach {100 * PROMISED:.0f} % too."
    return f" On rougher surfaces {failing} fall to {100 * float(rough.min()):.0f} %."
