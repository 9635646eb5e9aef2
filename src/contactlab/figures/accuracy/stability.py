"""Verdicts on the solvers by kind of test problem: one row a kind, one column a solver."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import COLOURS, WIDTH, Drawing, group

from ...accuracy.speed import OURS
from ...accuracy.stability import HONEST, NOT_OFFERED, RIGHT, SILENT, VERDICTS
from ...methods.registry import METHODS

TITLE = "Verdicts on every solver by kind of test problem"
SUBJECT = "study"
NEEDS = ("stability",)
KEY = "stability"
ORDER = 100

#: Colour and hatching of each verdict; silent errors are the darkest.
_STYLE: dict[int, dict[str, Any]] = {
    RIGHT: {"facecolor": "#cfe3f1"},
    HONEST: {"facecolor": COLOURS[5], "hatch": "////"},
    SILENT: {"facecolor": COLOURS[0]},
    NOT_OFFERED: {"facecolor": "white"},
}
_ROW = 0.145  # inches


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Fractions of the verdicts, kind by kind and solver by solver.

    Its data name the draws of every honest failure and of every silent error:
    ``hard_problem(kind, draw)`` of `contactlab.accuracy.hard_problems` makes each again.
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
    axes.set_xlabel("fraction of the test problems of a kind, each bar one solver's (1)")
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    for column in range(1, len(solvers)):
        axes.axvline(column - 0.03, color="0.7", lw=0.5)
    handles = [
        Patch(label=VERDICTS[verdict], **{"edgecolor": "0.4", "lw": 0.4, **style})
        for verdict, style in _STYLE.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return Drawing(
        figure, _table(stability, counts), caption(__name__, **_numbers(stability, counts))
    )


def _wrapped(name):
    """A solver's name, broken to the width of a column."""
    parts = re.sub("(?<=[a-z])(?=[A-Z])", "\n", name)
    return parts.replace("-", "-\n").replace(" ", "\n")


def _counts(stability):
    """Test problems by (solver, kind, verdict)."""
    verdict = stability["verdict"].transpose("solver", "kind", "draw").values
    return np.stack([(verdict == code).sum(axis=2) for code in range(len(VERDICTS))], axis=2)


def _table(stability, counts):
    """One row a kind and solver, with the draws that make each problem not solved again."""
    rows = []
    for k, kind in enumerate(stability["kind"].values):
        for n, solver in enumerate(stability["solver"].values):
            verdicts = stability.isel(kind=k, solver=n)
            failed = np.isin(verdicts["verdict"].values, (HONEST, SILENT))
            words = {_unmeasured(said) for said in verdicts["said"].values[failed]}
            rows.append(
                {"kind": kind, "solver": solver}
                | {
                    f"{name} (test problems)": counts[n, k, code]
                    for code, name in enumerate(VERDICTS)
                }
                | {"draws_honest_failure": _draws(verdicts, HONEST)}
                | {"draws_silently_wrong": _draws(verdicts, SILENT)}
                | {"violation_of_closure": verdicts["violation"].where(failed).max().item()}
                | {"tolerance_asked": verdicts["asked"].min().item()}
                | {"said": "; ".join(sorted(words - {""}))}
            )
    return pd.DataFrame(rows)


def _draws(verdicts, code):
    """The draws of one kind on which a solver had a verdict."""
    return " ".join(map(str, verdicts["draw"].values[verdicts["verdict"].values == code]))


def _unmeasured(said):
    """Message of a failure without the residual, which differs every time."""
    return said.partition("; best residual")[0]


def _numbers(stability, counts):
    """Verdicts on each solver, and how states are judged."""
    names = stability["solver"].values
    solvers = [
        (solver, row[RIGHT], row[[RIGHT, HONEST, SILENT]].sum(), row[SILENT])
        for solver, row in zip(names, counts.sum(axis=1), strict=True)
    ]
    public = not set(names) <= {OURS, *METHODS}
    return {
        "draws": stability.sizes["draw"],
        "kinds": stability.sizes["kind"],
        "solvers": solvers,
        "margin": f"{stability.attrs['margin']:g}",
        "rtol": f"{stability.attrs['rtol']:g}",
        "tightest": f"{stability.attrs['tightest']:g}" if public else "",
    }
