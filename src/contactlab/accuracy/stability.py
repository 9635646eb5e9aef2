"""Stability of solvers by kind of test problem: right, honest failure, or silently wrong."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled_dataset, titled
from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.contact.violation import violation
from roughcontact.errors import NotConverged

from ..methods.common import NotOffered
from ..methods.registry import METHODS, installed_peers
from .hard_problems import KINDS, hard_problem
from .hard_surfaces import HardProblem

RTOL = 1e-6
#: Largest violation of the contact conditions by a right state, in tolerances: the judge's rounding
#: differs from that of the methods.
MARGIN = 2.0
#: Largest difference of a right state's force (closure, if the force is given) from elimination's.
AGREEMENT = 1e-4
#: Tolerances of a public code, the next one tried while its state is not right: they are on
#: quantities of its own, so that a state that meets a loose one is not silently wrong.
PEER_RTOLS = (RTOL, 1e-8, 1e-10, 1e-12, 1e-14)

#: Verdicts, in the order of their codes.
VERDICTS = ("right", "honest failure", "silently wrong", "not offered")
RIGHT, HONEST, SILENT, NOT_OFFERED = range(len(VERDICTS))
#: Exceptions of a failure of the package's solvers; public codes may raise others.
_OWN_FAILURES = (NotConverged, ValueError)
_DIMS = ("kind", "draw", "solver")
#: Variables of `stability`: dimensions, unit, long name.
_STABILITY = {
    "verdict": (_DIMS, "1", ", ".join(f"{code} {name}" for code, name in enumerate(VERDICTS))),
    "violation": (_DIMS, "1", "largest violation of the contact conditions, relative to closure"),
    "disagreement": (_DIMS, "1", "relative difference from direct elimination"),
    "asked": (_DIMS, "1", "tolerance asked for"),
    "said": (_DIMS, "1", "message of the solver"),
}
_DTYPES: dict[str, Any] = {"verdict": "int8", "said": object}

#: A solver with the call of `fractalcontact.solve_contact`.
Solver = Callable[..., ContactState]


class Judgement(NamedTuple):
    """Verdict on a solver's answer to one problem, in the order of the variables."""

    verdict: int
    violation: float
    disagreement: float
    asked: float
    said: str


def solvers() -> dict[str, Solver]:
    """Solvers by name: ours first, the comparison methods, public codes if installed."""
    return {"fractalcontact": solve_contact, **METHODS, **installed_peers()}


def stability(kinds: Sequence[str] | None = None, draws: int = 25) -> xr.Dataset:
    """Verdicts on every solver.

    Parameters
    ----------
    kinds : sequence of str, optional
        Keys of `hard_problems.KINDS`; all by default.
    draws : int
        Problems of each kind.

    Returns
    -------
    xr.Dataset
        On (kind, draw, solver): ``verdict``, an index into `VERDICTS`; ``violation`` of the contact
        conditions relative to the closure, and ``disagreement`` with direct elimination, NaN where
        no state was returned; ``asked``, the tolerance at which it was judged: of peers one of
        `PEER_RTOLS`; ``said``, the message of a solver that failed.
        ``hard_problem(kind, draw)`` makes the problem again.
    """
    kinds = list(KINDS) if kinds is None else list(kinds)
    judged = solvers()
    judgements = [
        [_judge_all(judged, hard_problem(kind, draw)) for draw in range(draws)] for kind in kinds
    ]
    values = {
        name: np.array(
            [
                [[getattr(judgement, name) for judgement in problem] for problem in row]
                for row in judgements
            ],
            dtype=_DTYPES.get(name, float),
        )
        for name in _STABILITY
    }
    return labelled_dataset(
        _STABILITY,
        values,
        coords={"kind": kinds, "draw": np.arange(draws), "solver": list(judged)},
        attrs={
            "rtol": RTOL,
            "margin": MARGIN,
            "agreement": AGREEMENT,
            "tightest": min(PEER_RTOLS),
        },
    )


@titled("verdicts on the solvers by kind of test problem")
def join(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Verdicts of `stability` on several kinds, in the order of `hard_problems.KINDS`."""
    whole = xr.concat(parts, "kind", data_vars="minimal")
    return whole.sel(kind=[kind for kind in KINDS if kind in whole["kind"]])


def _judge_all(judged: Mapping[str, Solver], problem: HardProblem) -> list[Judgement]:
    """Judgements of every solver on one problem."""
    exact = _exact(problem)
    peers = installed_peers()
    return [
        _judge_patiently(solve, problem, exact, PEER_RTOLS, Exception)
        if name in peers
        else _judge_patiently(solve, problem, exact, (RTOL,), _OWN_FAILURES)
        for name, solve in judged.items()
    ]


def _judge_patiently(solve, problem, exact, tolerances, failures):
    """Judgement at the first tolerance where a solver is not silently wrong, or at the last."""
    for rtol in tolerances:
        judgement = _judge(solve, problem, exact, rtol, failures)
        if judgement.verdict != SILENT or not problem.solvable:
            break
    return judgement


def _exact(problem):
    """Force, or closure where the force is given, by direct elimination; NaN where that fails."""
    load = {key: value for key, value in problem.load.items() if key != "start"}
    try:
        state = METHODS["dense"](problem.height, problem.space, **load)
    except (NotConverged, ValueError):
        return np.nan
    return _answer(state, problem)


def _answer(state, problem):
    """Force of a problem with given closure, closure of one with given force."""
    return state.closure if "force" in problem.load else state.force


def _judge(solve, problem, exact, rtol, failures):
    """Judgement of a solver at one tolerance."""
    try:
        state = solve(problem.height, problem.space, rtol=rtol, **problem.load)
    except NotOffered as error:
        return Judgement(NOT_OFFERED, np.nan, np.nan, rtol, str(error))
    except failures as error:
        said = str(error) or type(error).__name__
        return Judgement(HONEST if problem.solvable else RIGHT, np.nan, np.nan, rtol, said)
    if not problem.solvable:
        return Judgement(SILENT, np.nan, np.nan, rtol, "a state where there is none")
    if state.closure == 0:
        unloaded = not any(problem.load.get(control) for control in ("closure", "force"))
        right = unloaded and not state.pressure.any()
        return Judgement(RIGHT if right else SILENT, 0.0, 0.0, rtol, "")
    worst, rounding = violation(state, np.asarray(problem.height, float))
    disagreement = abs(_answer(state, problem) / exact - 1)
    right = worst <= MARGIN * RTOL + rounding and not disagreement > AGREEMENT
    return Judgement(RIGHT if right else SILENT, worst, disagreement, rtol, "")
