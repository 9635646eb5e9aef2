"""Error against spacing for Hertz and the flat punch, and trials of Richardson's extrapolation."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core.estimate import EXPONENT, Estimate
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of, group
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.ticks import powers_of_ten
from fractalcontact.figures.kit.titles import letter

from ...accuracy.convergence import PROBLEM_QUANTITIES

TITLE = "Discretisation error where the solution is known, and Richardson extrapolation"
SUBJECT = "study"
NEEDS = ("convergence",)
KEY = "convergence"
ORDER = 90

_TITLES = ("paraboloid (Hertz)", "flat circular punch", "Richardson's extrapolation")


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Errors over s with their orders, and errors of Richardson's extrapolation over their bars."""
    figure = Figure(figsize=(WIDTH, 3.6))
    panels = figure.subplots(1, 3)
    panels[1].sharey(panels[0])
    groups = {problem: group(atlas, "convergence", problem) for problem in PROBLEM_QUANTITIES}
    trials = group(atlas, "convergence", "richardson")
    tables = [rows(trials, "error", "bar", "finest", problem="richardson")]
    for axes, (problem, result) in zip(panels, groups.items(), strict=False):
        _draw_errors(axes, result, PROBLEM_QUANTITIES[problem])
        named = [
            f"{name}_{of}" for name in PROBLEM_QUANTITIES[problem] for of in ("error", "order")
        ]
        tables.append(rows(result, *named, problem=problem))
    _draw_trials(panels[2], trials)
    for axes, which, title in zip(panels, "abc", _TITLES, strict=True):
        letter(axes, which, title)
        axes.set(xscale="log", yscale="log")
        powers_of_ten(axes.xaxis)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2))
    panels[0].set_ylabel("relative error, rms over positions (1)")
    table = pd.concat(tables, ignore_index=True)
    return Drawing(figure, table, caption(__name__, **_numbers(groups, trials)))


def _draw_errors(axes, result, quantities):
    spacing = 1 / result["cells_per_radius"].values
    for i, name in enumerate(quantities):
        order = Estimate.read(result, f"{name}_order", scale=EXPONENT).text()
        style = {"color": colour_of(i), "marker": MARKERS[i], "lw": 0.8}
        label = f"{name.replace('_', ' ')}: order {order}"
        axes.plot(spacing, result[f"{name}_error"], label=label, **style)
    axes.set_xlabel("spacing over contact radius $s/a$ (1)")


def _draw_trials(axes, trials):
    cases = trials.sizes["case"]
    for i, name in enumerate(trials["quantity"].values):
        of_quantity = trials.sel(quantity=name)
        style = {"ls": "none", "marker": MARKERS[i], "ms": 2, "color": colour_of(i)}
        label = f"{name}: {int(of_quantity['within'])} of {cases}"
        axes.plot(of_quantity["bar"], of_quantity["error"], label=label, **style)
    ends = [float(trials["bar"].min()), float(trials["bar"].max())]
    axes.plot(ends, ends, color="0.5", lw=0.8)
    axes.set_ylim(bottom=1e-3 * ends[0])
    axes.set_xlabel("its own error bar (1)")
    axes.set_ylabel("error of the extrapolated value (1)")


def _numbers(found, trials):
    """Orders of the force, and how often Richardson's error bar holds the error."""
    orders = [
        f"{problem} {Estimate.read(result, 'force_order', scale=EXPONENT).text()}"
        for problem, result in found.items()
        if "force" in PROBLEM_QUANTITIES[problem]
    ]
    cases = trials.sizes["case"]
    within = {
        str(name): int(trials["within"].sel(quantity=name)) for name in trials["quantity"].values
    }
    return {
        "orders": orders,
        "cases": cases,
        "within": [f"{name} {count}" for name, count in within.items()],
        "short_of": [name for name, count in within.items() if count < 0.9 * cases],
    }
