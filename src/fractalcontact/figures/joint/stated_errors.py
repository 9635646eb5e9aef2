"""The errors that the atlas states for its states, the largest of all offsets."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ..kit.axes import force_axis
from ..kit.caption import caption
from ..kit.drawing import COLOURS, LINES, MARKERS, WIDTH, Drawing
from ..kit.legends import entries, heading, legends_below
from ..kit.panel import rows
from ..kit.titles import headline
from ..kit.words import formulas, percent, place

TITLE = "Largest errors of all offsets: by the solver, and by the spacing"
SUBJECT = "specimen"
NEEDS = ("choices", "closure")
ORDER = 221

#: What is smaller is drawn here.
LEAST = 1e-6
#: Room at the right for a number beside the last point: a third of a decade.
_ROOM = 10 ** (1 / 3)


def draw(atlas: DataTree, name: str) -> Drawing:
    """The largest error of each quantity over the load, at the finest resolution."""
    subject = Subject.of(atlas, name)
    plan = subject["choices"]
    errors = rows(plan, "error_kind", "offsets_with_error", "median_error", "largest_error")
    errors = errors[errors["offsets_with_error"] > 0].reset_index(drop=True)
    relative = errors[errors["error_kind"] == "relative"]
    by_solver = relative["quantity"].isin(plan["quantity"].values[plan["error_is_by_solver"]])
    solver, spacing = relative[by_solver], relative[~by_solver]

    figure = Figure(figsize=(WIDTH, 3.7))
    axes = figure.subplots()
    size = force_axis(axes.xaxis, subject.forces)
    _draw_errors(axes, plan, errors, size)
    _write_ends(axes, solver, spacing, size)
    lines = entries(axes)
    of_spacing = []
    if len(spacing):
        of_spacing = [heading("by every second node: another surface"), lines.pop()]
    legends_below(figure, [heading("by the solver, bounds"), *lines], of_spacing)
    headline(figure, subject.label, place(subject.direction))
    worst = solver.loc[solver["largest_error"].idxmax()]
    absolute = errors.loc[errors["error_kind"] == "absolute", "largest_error"]
    ends = spacing["largest_error"].min(), spacing["largest_error"].max()
    words = {"worst": worst, "absolute": absolute.max(), "ends": ends if len(spacing) else ()}
    return Drawing(figure, errors, caption(__name__, **words))


def _draw_errors(axes, plan, errors, size):
    """A line a quantity, that by the spacing the last."""
    for i, quantity in enumerate(plan["quantity"].values):
        drawn = errors[errors["quantity"] == quantity]
        # Lines that lie on each other stay visible: the later ones are smaller.
        style = {"color": COLOURS[i + 1], "marker": MARKERS[i], "ls": LINES[i % len(LINES)]}
        style |= {"ms": 6.5 - i, "lw": 2 - 0.3 * i}
        if not plan["error_is_by_solver"][i]:
            style = {"color": "0.6", "marker": "x", "ls": "-", "lw": 2.5}
        label = formulas(str(quantity))
        label += ", in 0.01" if plan["error_kind"][i] == "absolute" else ""
        heights = 100 * np.maximum(drawn["largest_error"], LEAST)
        if len(drawn):
            axes.plot(drawn["normal_force_N"] / size, heights, label=label, **style)
    axes.set(xscale="log", yscale="log")
    axes.set_ymargin(0.12)
    axes.set_ylabel("largest error (% of the value, or in 0.01)")
    axes.set_title(f"at the bottom: errors of {100 * LEAST:g} and less", loc="left")


def _write_ends(axes, solver, spacing, size):
    """Labels of the largest solver error and of the extremes by the spacing.

    They stand above their points, that by the solver at the heaviest load at the right of its own:
    there those by the spacing may be near.
    """
    quoted = {}
    if len(solver):
        worst = solver.loc[solver["largest_error"].idxmax()]
        quoted[worst.name] = worst["normal_force_N"] == solver["normal_force_N"].max()
    if len(spacing):
        largest = spacing["largest_error"]
        quoted |= {largest.idxmin(): False, largest.idxmax(): False}
    for number, beside in quoted.items():
        row = (solver if number in solver.index else spacing).loc[number]
        error = row["largest_error"]
        at = row["normal_force_N"] / size, 100 * max(error, LEAST)
        where = {"xytext": (6, 0) if beside else (0, 6), "textcoords": "offset points"}
        where |= {"ha": "left", "va": "center"} if beside else {"ha": "center"}
        axes.annotate(percent(error), at, **where)
    low, high = axes.get_xlim()
    axes.set_xlim(low, high * _ROOM)
