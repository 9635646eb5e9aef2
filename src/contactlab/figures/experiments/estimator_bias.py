"""Bias and coverage of the estimators of Delta_g on synthetic surfaces of known H."""

from collections.abc import Sequence
from itertools import product

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.points import hollow_entry
from fractalcontact.figures.kit.titles import letter

TITLE = "Bias, scatter and coverage of the estimators of the surface dimension"
SUBJECT = "study"
NEEDS = ("estimator_bias",)
KEY = "estimator_bias"
ORDER = 40


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Bias with scatter, and coverage, by H, size, roll-off and estimator."""
    bias = atlas["estimator_bias/surfaces"].to_dataset()
    surfaces = list(product(bias["size"].values, bias["roll_off"].values))
    columns = bias.sizes["roll_off"]
    figure = Figure(figsize=(WIDTH, 0.8 + 4.8 * bias.sizes["size"]))
    heights = [1.6, 1] * bias.sizes["size"]
    panels = figure.subplots(
        len(heights), columns, sharex=True, sharey="row", squeeze=False, height_ratios=heights
    )
    letters = iter("abcdefghijklmnopqrstuvwxyz")
    for n, (size, roll_off) in enumerate(surfaces):
        row, column = 2 * (n // columns), n % columns
        panel_bias = bias.sel(size=size, roll_off=roll_off)
        _draw_bias(panels[row, column], panel_bias)
        _draw_coverage(panels[row + 1, column], panel_bias)
        letter(panels[row, column], next(letters), f"bias, {_surface_words(size, roll_off)}")
        letter(panels[row + 1, column], next(letters), "95 % intervals that hold the true $H$")
    for upper, lower in zip(panels[::2, 0], panels[1::2, 0], strict=True):
        upper.set_ylabel("estimated less true $H$ (1)")
        lower.set_ylabel("surfaces (%)")
    places = np.arange(bias.sizes["hurst"])
    for panel in panels[-1]:
        panel.set_xlim(-0.5, bias.sizes["hurst"] - 0.5)
        panel.set_xticks(places, [f"{hurst:g}" for hurst in bias["hurst"].values])
        panel.set_xlabel("Hurst exponent $H$ of the surfaces (1)")
    aim, *estimators = entries(panels[0, 0])
    head = heading(f"rms error of $H$, from $H$ = {bias.attrs['from_hurst']:g} on")
    half = -(-len(estimators) // 2)
    others = [aim, *entries(panels[1, 0]), heading("bars: sd between surfaces")]
    legends_below(
        figure,
        [head, *estimators[:half]],
        [heading(" "), *estimators[half:]],
        others,
        columnspacing=2,
    )
    table = rows(bias, "bias", "slope_bias", "scatter", "rms_error", "half_width", "coverage")
    return Drawing(figure, table, caption(__name__, **_words(bias)))


def _surface_words(size, roll_off):
    """Surfaces of one panel: nodes and roll-off."""
    if not np.isfinite(roll_off):
        return rf"{size}$^2$ nodes, no roll-off"
    return rf"{size}$^2$ nodes, roll-off at 1/{1 / roll_off:.3g} of the side"


def _beside(bias, n):
    """Positions of the n-th estimator's points, shifted from those of the others."""
    step = 0.65 / bias.sizes["estimator"]
    return np.arange(bias.sizes["hurst"]) + (n - (bias.sizes["estimator"] - 1) / 2) * step


def _label(bias, name):
    """An estimator in the legend, with the rms error that the caption compares."""
    error = float(bias["overall_error"].sel(estimator=name))
    words = _name(name) + (" (recommended)" if name == bias.attrs["recommended"] else "")
    return f"{words}: {error:.3f}" if np.isfinite(error) else words


def _style(n):
    return {"color": colour_of(n), "marker": MARKERS[n % len(MARKERS)], "ls": "none"}


def _draw_bias(axes, bias):
    aim = bias.attrs["tolerated_bias"]
    axes.axhspan(-aim, aim, color="0.9", lw=0, label=rf"aim: bias within {aim:g}")
    for n, name in enumerate(bias["estimator"].values):
        of_estimator, x = bias.sel(estimator=name), _beside(bias, n)
        label = _label(bias, name)
        axes.errorbar(
            x,
            of_estimator["bias"],
            of_estimator["scatter"],
            capsize=2,
            lw=0.8,
            label=label,
            **_style(n),
        )
        moved = np.abs(of_estimator["slope_bias"] - of_estimator["bias"]) > 1e-9
        axes.plot(
            x[moved], of_estimator["slope_bias"][moved], mfc="none", mew=0.7, alpha=0.8, **_style(n)
        )


def _draw_coverage(axes, bias):
    aim = 100 * bias.attrs["promised_coverage"]
    axes.axhline(aim, color="0.4", lw=0.8, ls="--", label=f"aim: {aim:.0f} % of the surfaces")
    for n, name in enumerate(bias["estimator"].values):
        axes.plot(_beside(bias, n), 100 * bias["coverage"].sel(estimator=name), **_style(n))
    axes.set_ylim(min(45, 90 * float(bias["coverage"].min())), 105)
    hollow_entry(axes, "hollow: before known bias is taken off")


def _words(bias):
    """Errors and coverage of the estimators where their bias is determined."""
    start = bias.attrs["from_hurst"]
    determined = bias.sel(estimator=bias["worst_bias"].notnull())
    names = [_name(name) for name in determined["estimator"].values]
    errors = dict(zip(names, determined["overall_error"].values.tolist(), strict=True))
    least = dict(zip(names, determined["min_coverage"].values.tolist(), strict=True))
    return {
        "seeds": bias.sizes["seed"],
        "start": start,
        "name": _name(bias.attrs["recommended"]),
        "errors": errors,
        "least": least,
    }


def _name(estimator):
    """An estimator in words."""
    return str(estimator).replace("_", " ")
