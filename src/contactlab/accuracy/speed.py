"""Error against time: every solver and every cheaper model on a test problem, measured in turn.

Set-up for a grid (kernel, transforms, the topography handed over to another code) is not timed;
every solve starts cold. A method's tolerances are tried from loose to tight until
one takes too long or fails; all tolerances of our solver are tried.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from fractalcontact.core.child_process import ChildFailed, in_child
from fractalcontact.core.datasets import labelled_dataset, titled
from fractalcontact.core.labels import cf_attrs
from fractalcontact.domain.box_dimension import dimension_of_domain
from roughcontact import threads
from roughcontact.contact.preconditioner import forget_preconditioner
from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..methods.method import Method
from ..methods.peers import PATIENCE, Load, PublicCode, clearance_of, state_of
from ..methods.registry import METHODS, installed_peers
from .cheap_models import CheapState, bearing_area, coarse_grid, winkler
from .reference import Reference, ReferenceProblem, hertz_problem, problems_of
from .timing import peak_memory, repeated, timed

OURS = "fractalcontact"
SOLVER, PEER, MODEL = "solver", "peer", "model"
#: The cheaper models by name.
MODELS: dict[str, Callable[..., CheapState]] = {
    "bearing area": bearing_area,
    "Winkler": winkler,
    "coarse grid": coarse_grid,
}
#: Our tolerance whose memory is measured: the default.
DEFAULT_RTOL = 1e-6
#: Error below which the production solver is meant to be the fastest.
LEADS_BELOW = 1e-2

#: Errors of every point against the reference.
ERRORS = {
    "force_error": "error of the force, relative",
    "area_error": "error of the real contact area, relative",
    "delta_error": "error of Delta_sigma from box counts",
    "pressure_error": "error of the pressure field, root mean square over that of the reference",
}
#: Fronts of error and time, and the error of each.
FRONTS = {"on_front": "force_error", "on_pressure_front": "pressure_error"}
#: Columns of text of `error_against_time`, and those of numbers, NaN where a way failed:
#: dimensions, unit, long name.
_TEXTS = {
    "method": ("point", "1", "solver or model"),
    "kind": ("point", "1", "solver of the package, peer or cheaper model"),
    "said": ("point", "1", "message of the solver that failed"),
}
_NUMBERS = {
    **{name: ("point", "1", words) for name, words in ERRORS.items()},
    "seconds": ("point", "s", "wall time of a cold solve, median of the runs"),
    "seconds_low": ("point", "s", "wall time, fastest run"),
    "seconds_high": ("point", "s", "wall time, slowest run"),
    "runs": ("point", "1", "runs"),
    "memory": ("point", "B", "peak memory of setting up and solving, on one thread"),
    "applications": ("point", "1", f"applications of the operator by {OURS}, on the full grid"),
}
_TOLERANCE = {"tolerance": ("point", "1", "tolerance asked for")}


@dataclass(frozen=True)
class _Way:
    """One way to solve a test problem.

    ``solve`` is timed, ``finish`` makes a state of its result, and ``from_scratch`` includes the
    set-up: a process needs the memory of both.
    """

    method: str
    kind: str
    tolerance: float
    solve: Callable[[], Any]
    finish: Callable[[Any], ContactState | CheapState]
    from_scratch: Callable[[], Any]


@titled("error against time of solvers and cheaper models, one group per test problem")
def speed(problem: str, recipe: Mapping[str, Any]) -> xr.Dataset:
    """:func:`error_against_time` of a problem of `reference.problems_of`, by a study's recipe."""
    return error_against_time(problems_of(recipe)[problem](), recipe)


def error_against_time(problem: ReferenceProblem, recipe: Mapping[str, Any]) -> xr.Dataset:
    """Errors, seconds and memory of every way to solve a test problem.

    Other programs on the machine disturb the seconds.

    Parameters
    ----------
    problem : ReferenceProblem
    recipe : mapping
        ``tolerances``; ``runs`` of each way, of which the median counts; ``longest``, seconds from
        which on a way is run once and, but of ours, no tighter tolerance tried; ``slow_nodes``,
        most interpenetrating nodes for methods that write out the influence matrix.

    Returns
    -------
    xr.Dataset
        On ``point``, with ``method``, ``kind`` and ``tolerance`` (NaN where there is none):
        `ERRORS`, ``seconds`` (median; ``seconds_low`` and ``seconds_high`` are the fastest and the
        slowest run), ``runs``, ``memory`` (once per method), ``applications`` of the operator (of
        ours), ``said`` (of a failure), and ``on_front`` and ``on_pressure_front``: whether nothing
        else is both faster and closer. Attributes describe the problem, the reference and its
        error; errors below ``resolvable_error``, the tightest tolerance, count as alike.
    """
    _warm_up(recipe)
    table, ways = _first_runs(problem, recipe)
    again = repeated(
        [way.solve for way in ways],
        [row["seconds"] for row in table if not row["said"]],
        runs=recipe["runs"],
        longest=recipe["longest"],
    )
    for row, runs in zip((row for row in table if not row["said"]), again, strict=True):
        row |= {"seconds": np.median(runs), "seconds_low": min(runs), "seconds_high": max(runs)}
        row["runs"] = len(runs)
    measured = {way.method: way for way in ways if not way.tolerance < DEFAULT_RTOL}
    memory = {method: peak_memory(way.from_scratch) for method, way in measured.items()}
    for row in table:
        row["memory"] = memory.get(row["method"], np.nan)
    result = _labelled(table).assign_attrs(_about_problem(problem))
    # Errors below the tightest requested tolerance, or below the reference's own error, count as
    # alike.
    asked = min(recipe["tolerances"])
    result.attrs["resolvable_error"] = max(result.attrs["reference_error"], asked)
    for name, error in FRONTS.items():
        words = f"nothing is both faster and has less {ERRORS[error]}"
        result[name] = ("point", _front(result, error), cf_attrs("1", words))
    return result


def _first_runs(problem, recipe):
    """Rows of all ways, each run once, and the ways that gave a state."""
    dimension = dimension_of_domain(problem.single.state.in_contact, 1.0).dimension
    table, ways = [], []
    for ladder in _ladders(problem, recipe):
        for way in ladder:
            row = {"method": way.method, "kind": way.kind, "tolerance": way.tolerance, "said": ""}
            table.append(row)
            try:
                # Foreign code may crash or never end: it is tried where that does no harm.
                if way.kind == PEER:
                    in_child(way.solve, seconds=PATIENCE)
                raw, row["seconds"] = timed(way.solve)
            except (NotConverged, ChildFailed) as failure:
                row["said"] = str(failure)
                break
            state = way.finish(raw)
            row |= errors_of(state, problem.single, dimension)
            if way.method == OURS:
                row["applications"] = state.iterations
            ways.append(way)
            # A direct method is as close at its loosest tolerance as at any other.
            reached = getattr(state, "residual", np.inf) <= min(recipe["tolerances"])
            too_long = row["seconds"] > recipe["longest"] and way.method != OURS
            if reached or too_long:
                break
    return table, ways


def _ladders(problem: ReferenceProblem, recipe: Mapping[str, Any]) -> Iterator[list[_Way]]:
    """Ways of every method from loose to tight."""
    tolerances = sorted(recipe["tolerances"], reverse=True)
    yield _of_solver(OURS, solve_contact, problem, tolerances)
    for name, method in METHODS.items():
        if method.largest is None or problem.overlapping <= recipe["slow_nodes"]:
            steps = [np.nan] if method.direct else tolerances
            yield _of_solver(name, method, problem, steps)
    for name, peer in installed_peers().items():
        if not peer.takes(problem.space):
            continue
        yield _of_peer(name, peer, problem, tolerances)
    height, space, closure = problem.height, problem.space, problem.closure
    for name, model in MODELS.items():
        solve = partial(model, height, space, closure=closure)
        from_scratch = partial(_on_a_new_grid, model, height, space, closure, np.nan)
        yield [_Way(name, MODEL, np.nan, solve, _as_it_is, from_scratch)]


def _of_solver(name, press, problem, tolerances):
    """Ways of a solver of the package."""
    arguments = press, problem.height, problem.space, problem.closure
    return [
        _Way(
            *(name, SOLVER, rtol),
            solve=partial(_cold, *arguments, rtol),
            finish=_as_it_is,
            from_scratch=partial(_on_a_new_grid, *arguments, rtol),
        )
        for rtol in tolerances
    ]


def _of_peer(name, peer, problem, tolerances):
    """Ways of a public code, set up once."""
    code = peer.set_up(problem.height, problem.space)
    control = peer.loads[0]
    return [
        _Way(
            *(name, PEER, rtol),
            solve=partial(_press_peer, code, control, problem.single, rtol),
            finish=partial(_peer_state, control, problem),
            from_scratch=partial(_set_up_and_press, peer, problem, rtol),
        )
        for rtol in tolerances
    ]


def _cold(press, height, space, closure, rtol):
    """Cold solve, without anything stored of the last contact set."""
    forget_preconditioner(space)
    options = {} if np.isnan(rtol) else {"rtol": rtol}
    return press(height, space, closure=closure, **options)


def _on_a_new_grid(press, height, space, closure, rtol):
    """Cold solve with kernel and transforms made anew."""
    kernel, boundary = space.kernel, space.boundary
    grid = space.shape, space.spacing
    new = HalfSpace(*grid, space.modulus, kernel=kernel, boundary=boundary)
    return _cold(press, height, new, closure, rtol)


def _as_it_is(state):
    return state


def _press_peer(code: PublicCode, control: str, reference: Reference, rtol: float) -> np.ndarray:
    """Pressure of a public code at the reference's closure, or under its force."""
    # The reference force, for codes whose tolerance is on forces.
    exact = reference.state
    pixel_force = exact.force / np.count_nonzero(exact.in_contact)
    load = Load(**{control: getattr(exact, control)}, pixel_force=pixel_force)
    return code.solve(load, rtol)


def _set_up_and_press(peer: Method, problem: ReferenceProblem, rtol: float) -> np.ndarray:
    code = peer.set_up(problem.height, problem.space)
    return _press_peer(code, peer.loads[0], problem.single, rtol)


def _peer_state(control, problem, pressure):
    """State of a public code's pressure."""
    load = {control: getattr(problem.single.state, control)}
    return state_of(problem.space, pressure, clearance_of(problem.height), **load)


def _warm_up(recipe):
    """Solve a few nodes once by every method, so that compiled code is loaded before timing."""
    _first_runs(hertz_problem(16), {**recipe, "tolerances": recipe["tolerances"][:1]})


def errors_of(
    state: ContactState | CheapState, reference: Reference, dimension: float
) -> dict[str, float]:
    """Errors of a state, by the names of `ERRORS`; ``dimension`` is the reference's Delta_sigma."""
    exact = reference.state
    same = np.array_equal(state.in_contact, exact.in_contact)
    reached = dimension if same else dimension_of_domain(state.in_contact, 1.0).dimension
    norm = np.sqrt(np.mean(exact.pressure**2))
    return {
        "force_error": float(reference.error(state)),
        "area_error": abs(state.area / exact.area - 1),
        "delta_error": abs(reached - dimension),
        "pressure_error": float(np.sqrt(np.mean((state.pressure - exact.pressure) ** 2)) / norm),
    }


def pareto_front(seconds: ArrayLike, error: ArrayLike) -> np.ndarray:
    """Pareto front (n,) of time and error: no other point is both faster and closer.

    A point with a NaN is on no front; of points alike in both all are on it.
    """
    seconds, error = np.asarray(seconds, float), np.asarray(error, float)
    finite = np.isfinite(seconds) & np.isfinite(error)
    no_worse = (seconds <= seconds[:, np.newaxis]) & (error <= error[:, np.newaxis])
    better = (seconds < seconds[:, np.newaxis]) | (error < error[:, np.newaxis])
    return finite & ~(no_worse & better & finite).any(axis=1)


def _front(points, quantity):
    """Pareto front of an error; below ``resolvable_error`` all points are equally close."""
    error = np.maximum(points[quantity].values, points.attrs["resolvable_error"])
    return pareto_front(points["seconds"].values, error)


def ahead_of_ours(
    points: xr.Dataset,
    *,
    quantity: str = "force_error",
    below: float = LEADS_BELOW,
    models: bool = True,
) -> xr.Dataset:
    """Points of others on the front below an error, where our solver is not the fastest way.

    ``quantity`` is a key of `ERRORS`; with ``models`` the cheaper models count, without them only
    solvers of the same problem.
    """
    if not models:
        points = points.isel(point=np.flatnonzero(points["kind"] != MODEL))
    others = (points[quantity] < below) & (points["method"] != OURS)
    return points.isel(point=np.flatnonzero(_front(points, quantity) & others))


def _labelled(rows: Sequence[Mapping[str, Any]]) -> xr.Dataset:
    """Dataset of the rows."""
    values: dict[str, np.ndarray] = {
        name: np.array([row[name] for row in rows], dtype=object) for name in _TEXTS
    }
    values["tolerance"] = np.array([row["tolerance"] for row in rows], dtype=float)
    for name in _NUMBERS:
        column = [row.get(name, np.nan) if not row["said"] else np.nan for row in rows]
        values[name] = np.array(column, float)
    return labelled_dataset(_TEXTS | _TOLERANCE | _NUMBERS, values)


def _about_problem(problem):
    """Attributes: the problem, its reference, and the seconds of one operator application.

    The application is in single precision, as all but one or two of our solver's are.
    """
    reference, space = problem.single, problem.space
    field = reference.state.pressure.astype(np.float32)
    applied = [timed(partial(space.convolve, field))[1] for _ in range(9)]
    return {
        "scene": problem.name,
        "size": problem.size,
        "hurst": problem.hurst,
        "contact": problem.fraction,
        "contact_reached": float(reference.fraction),
        "overlapping": int(problem.overlapping),
        "reference_tolerance": reference.tolerance,
        "reference_error": reference.own_error(problem.height),
        "elimination_error": float(problem.eliminated()),
        "application_seconds": float(np.median(applied)),
        "threads": threads.count(),
        "leads_below": LEADS_BELOW,
    }
