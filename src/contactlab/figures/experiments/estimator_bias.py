"""Bias and coverage of the estimators of Delta_g on synthetic surfaces of known H."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import LINES, MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.titles import letter

TITLE = "Bias, scatter and coverage of the estimators of the surface dimension"
SUBJECT = "study"
NEEDS = ("estimator_bias",)
KEY = "estimator_bias"
ORDER = 40


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Bias with scatter, and coverage, by H, size, roll-off and estimator."""
    bias = atlas["estimator_bias/surfaces"].to_dataset()
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
            letter(panel, next(letters), "95 % intervals that hold the true $H$")
        panels[2 * row, 0].set_ylabel("estimated less true $H$ (1)")
        panels[2 * row + 1, 0].set_ylabel("surfaces (%)")
    places = np.arange(bias.sizes["hurst"])
    for panel in panels[-1]:
        panel.set_xlim(-0.5, bias.sizes["hurst"] - 0.5)
        panel.set_xticks(places, [f"{hurst:g}" for hurst in bias["hurst"].values])
        panel.set_xlabel("Hurst exponent $H$ of the surfaces (1)")
    legends_below(figure, *_legends(panels[0, 0], panels[1, 0], bias.attrs["from_hurst"]))
    figure.suptitle(
        f"{bias.sizes['seed']} synthetic surfaces each, bars: standard deviation between surfaces; "
        "estimators side by side",
        fontsize=9,
    )
    table = rows(bias, "bias", "slope_bias", "scatter", "rms_error", "half_width", "coverage")
    return Drawing(figure, table, caption(__name__, **_words(bias)))


def _legends(of_bias, of_coverage, start):
    """Legend entries in two columns: estimators with their errors, then all others."""
    estimators = [one for one in entries(of_bias) if not isinstance(one, Patch | Line2D)]
    half = -(-len(estimators) // 2)
    hollow = mark(color="0.3", marker="o", mfc="none", ls="none")
    hollow.set_label("hollow: before known bias is taken off")
    others = [one for one in entries(of_bias) if isinstance(one, Patch | Line2D)]
    head = heading(f"rms error of $H$, from $H$ = {start:g} on")
    return (
        [head, *estimators[:half]],
        [heading(" "), *estimators[half:]],
        [hollow, *others, *entries(of_coverage)],
    )


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


def _draw_bias(axes, bias):
    aim = bias.attrs["tolerated_bias"]
    axes.axhspan(-aim, aim, color="0.9", lw=0, label=rf"aim: bias within {aim:g}")
    for n, name in enumerate(bias["estimator"].values):
        one, x = bias.sel(estimator=name), _beside(bias, n)
        style = {"color": colour_of(n), "marker": MARKERS[n % len(MARKERS)], "ls": "none"}
        label = _label(bias, name)
        axes.errorbar(x, one["bias"], one["scatter"], capsize=2, lw=0.8, label=label, **style)
        moved = np.abs(one["slope_bias"] - one["bias"]) > 1e-9
        axes.plot(x[moved], one["slope_bias"][moved], mfc="none", mew=0.7, alpha=0.8, **style)


def _draw_coverage(axes, bias):
    aim = 100 * bias.attrs["promised_coverage"]
    words = f"aim: {aim:.0f} % of the surfaces"
    axes.axhline(aim, color="0.4", lw=0.8, ls=LINES[1], label=words)
    for n, name in enumerate(bias["estimator"].values):
        axes.plot(
            _beside(bias, n),
            100 * bias["coverage"].sel(estimator=name),
            color=colour_of(n),
            marker=MARKERS[n % len(MARKERS)],
            ls="none",
        )
    axes.set_ylim(min(45, 90 * float(bias["coverage"].min())), 105)


def _words(bias):
    """Errors and coverage of the estimators where their bias is known, and on rougher surfaces."""
    start = bias.attrs["from_hurst"]
    known = bias.sel(estimator=bias["worst_bias"].notnull())
    names = [_name(name) for name in known["estimator"].values]
    errors = dict(zip(names, known["overall_error"].values.tolist(), strict=True))
    least = dict(zip(names, known["min_coverage"].values.tolist(), strict=True))
    rough = bias["rough_coverage"]
    return {
        "seeds": bias.sizes["seed"],
        "start": start,
        "name": _name(bias.attrs["recommended"]),
        "errors": errors,
        "least": least,
        "promised": bias.attrs["promised_coverage"],
        "rough": rough.values[rough.notnull()].tolist(),
    }


def _name(estimator):
    """An estimator in words."""
    return str(estimator).replace("_", " ")
