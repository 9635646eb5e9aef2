"""Which solver takes which kind of scene: one row a kind, one column a solver."""

import re

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ...accuracy.speed import OURS
from ...accuracy.stability import HONEST, NOT_OFFERED, RIGHT, SILENT, VERDICTS
from ...methods.registry import METHODS
from ..kit.drawing import COLOURS, WIDTH, Drawing, group

#: Colour and hatching of each verdict: what must not happen is the darkest.
_STYLE = {
    RIGHT: {"facecolor": "#cfe3f1"},
    HONEST: {"facecolor": COLOURS[5], "hatch": "////"},
    SILENT: {"facecolor": COLOURS[0]},
    NOT_OFFERED: {"facecolor": "white"},
}
_ROW = 0.145  # inches


def draw(atlas, names):
    """Shares of the verdicts, kind by kind and solver by solver.

    Parameters
    ----------
    atlas : xr.DataTree
    names : list of str
        Specimens of the study; the scenes here are none of them.

    Returns
    -------
    Drawing
        Its data name the draws of every honest failure and of every silent error:
        ``hard_problem(kind, draw)`` of `fractalcontact.accuracy.hard_problems` makes each again.
    """
    stability = group(atlas, "stability", "scenes")
    counts = _counts(stability)
    kinds, solvers = stability["kind"].values, stability["solver"].values
    figure = Figure(figsize=(WIDTH, 1.2 + _ROW * len(kinds)))
    axes = figure.subplots()
    for column in range(len(solvers)):
        left = np.full(len(kinds), float(column))
        for verdict, style in _STYLE.items():
            width = 0.94 * counts[column, :, verdict] / stability.sizes["draw"]
            axes.barh(np.arange(len(kinds)), width, 0.82, left=left, lw=0, **style)
            left += width
    axes.set_xlim(-0.03, len(solvers))
    axes.set_ylim(len(kinds) - 0.4, -0.6)
    axes.set_yticks(np.arange(len(kinds)), kinds, fontsize=6.5)
    names = [_wrapped(name) for name in solvers]
    axes.set_xticks(np.arange(len(solvers)) + 0.47, names, fontsize=6.5)
    axes.xaxis.tick_top()
    axes.set_xlabel("share of the scenes of a kind, each bar one solver's (1)")
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    for column in range(1, len(solvers)):
        axes.axvline(column - 0.03, color="0.7", lw=0.5)
    handles = [
        Patch(label=VERDICTS[verdict], **{"edgecolor": "0.4", "lw": 0.4, **style})
        for verdict, style in _STYLE.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return Drawing(figure, _table(stability, counts), _caption(stability, counts))


def _wrapped(name):
    """A solver's name, broken to the width of a column."""
    parts = re.sub("(?<=[a-z])(?=[A-Z])", "\n", name)
    return parts.replace("-", "-\n").replace(" ", "\n")


def _counts(stability):
    """Scenes by (solver, kind, verdict)."""
    verdict = stability["verdict"].transpose("solver", "kind", "draw").values
    return np.stack([(verdict == code).sum(axis=2) for code in range(len(VERDICTS))], axis=2)


def _table(stability, counts):
    """One row a kind and solver, with the draws that make each scene not solved again."""
    rows = []
    for k, kind in enumerate(stability["kind"].values):
        for n, solver in enumerate(stability["solver"].values):
            one = stability.isel(kind=k, solver=n)
            failed = np.isin(one["verdict"].values, (HONEST, SILENT))
            words = {_unmeasured(said) for said in one["said"].values[failed]}
            rows.append(
                {"kind": kind, "solver": solver}
                | {f"{name} (scenes)": counts[n, k, code] for code, name in enumerate(VERDICTS)}
                | {"draws_honest_failure": _draws(one, HONEST)}
                | {"draws_silently_wrong": _draws(one, SILENT)}
                | {"violation_of_closure": one["violation"].where(failed).max().item()}
                | {"tolerance_asked": one["asked"].min().item()}
                | {"said": "; ".join(sorted(words - {""}))}
            )
    return pd.DataFrame(rows)


def _draws(verdicts, code):
    """The draws of one kind on which a solver had a verdict."""
    return " ".join(map(str, verdicts["draw"].values[verdicts["verdict"].values == code]))


def _unmeasured(said):
    """What was said of a failure, without the residual, which is another every time."""
    return said.partition("; best residual")[0]


def _caption(stability, counts):
    totals = counts.sum(axis=1)
    tried = stability.sizes["kind"] * stability.sizes["draw"]
    by_solver = "; ".join(
        _words(*row) for row in zip(stability["solver"].values, totals, strict=True)
    )
    return (
        f"In no figure of the paper: {stability.sizes['kind']} kinds of scene, "
        f"{stability.sizes['draw']} drawn of each, {tried} in all. A state is right if it violates "
        f"the contact conditions, judged in double precision by a convolution of the judge's own, "
        f"by no more than {stability.attrs['margin']:g} times the tolerance of "
        f"{stability.attrs['rtol']:g} beyond the rounding of the heights, and if its force (its "
        "closure, where the force was given) is that of direct elimination to "
        f"{stability.attrs['agreement']:g}. Where no state exists, only saying so is right. "
        f"{_of_peers(stability)}{by_solver}. {_silent(stability)} Every scene not solved stands in "
        "the table beside the figure, kind and draw: hard_problem(kind, draw) of "
        "fractalcontact.accuracy.hard_problems makes it again."
    )


def _of_peers(stability):
    """How public codes are judged, where there are any."""
    if set(stability["solver"].values) <= {OURS, *METHODS}:
        return ""
    return (
        "A public code, whose tolerance is on a quantity of its own, is asked for a tighter one, "
        f"down to {stability.attrs['tightest']:g}, before it counts as silently wrong; an error it "
        "raises, a crash and too long a time are honest failures. "
    )


def _silent(stability):
    """Every silent error, by kind and draw."""
    found = []
    for solver in stability["solver"].values:
        wrong = stability.sel(solver=solver)
        wrong = wrong.isel(kind=np.flatnonzero((wrong["verdict"] == SILENT).any("draw")))
        kinds = [f"{k} ({_draws(wrong.sel(kind=k), SILENT)})" for k in wrong["kind"].values]
        if kinds:
            found.append(f"{solver} on {'; '.join(kinds)}")
    return f"Silently wrong, with the draws: {'. '.join(found)}." if found else "None is silent."


def _words(solver, totals):
    offered = totals[[RIGHT, HONEST, SILENT]].sum()
    return (
        f"{solver}: {totals[RIGHT]} of {offered} right, {totals[HONEST]} honest failures, "
        f"{totals[SILENT]} silently wrong"
    )
