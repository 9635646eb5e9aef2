"""Error against time: every solver and every cheaper model on one scene, measured in turn.

What is set up once for a grid (kernel, transforms, the topography handed over to another code) is
timed for nobody; every solve starts cold. A method's tolerances are tried from loose to tight until
one takes too long or fails; ours goes through all of them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import xarray as xr

from ..contact.preconditioner import forget_preconditioner
from ..contact.solve import solve_contact
from ..core import threads
from ..core.child_process import ChildFailed, in_child
from ..core.errors import NotConverged
from ..core.labels import cf_attrs
from ..domain.box_dimension import box_dimension
from ..elastic.halfspace import HalfSpace
from ..methods import peers
from ..methods.registry import METHODS
from .cheap_models import bearing_area, coarse_grid, winkler
from .reference import HertzScene
from .timing import peak_memory, repeated, timed

OURS = "fractalcontact"
SOLVER, PEER, MODEL = "solver", "peer", "model"
#: The cheaper models by name.
MODELS = {"bearing area": bearing_area, "Winkler": winkler, "coarse grid": coarse_grid}
#: Methods that write out the influence of every node on every other, and need many of them.
SLOW = ("dense", "paper", "gauss-seidel", "nnls")
#: The method without a tolerance: direct, and exact but for rounding.
DIRECT = "dense"
#: Our tolerance whose memory is measured: the default.
DEFAULT_RTOL = 1e-6
#: Below this error the production solver is meant to be the fastest.
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


@dataclass(frozen=True)
class _Way:
    """One way to solve a scene.

    ``solve`` is timed, ``finish`` makes a state of what it returns, and ``from_scratch`` does all
    that is set up once too: a process needs the memory of both.
    """

    method: str
    kind: str
    tolerance: float
    solve: Callable
    finish: Callable
    from_scratch: Callable


def error_against_time(scene, recipe):
    """Errors, seconds and memory of every way to solve a scene.

    What else runs on the machine disturbs the seconds: nothing should.

    Parameters
    ----------
    scene : RoughScene, HertzScene or PunchScene
        Of `reference_scenes`.
    recipe : mapping
        ``tolerances``; ``runs`` of each way, of which the median counts; ``longest``, seconds from
        which on a way is run once and, but of ours, no tighter tolerance tried; ``slow_nodes``,
        interpenetrating nodes up to which the methods of `SLOW` are tried.

    Returns
    -------
    xr.Dataset
        On ``point``, with ``method``, ``kind`` and ``tolerance`` (NaN where there is none):
        `ERRORS`, ``seconds`` (median; ``seconds_low`` and ``seconds_high`` are the fastest and the
        slowest run), ``runs``, ``memory`` (once a method), ``applications`` of the operator (of
        ours), ``said`` (of a failure), and ``on_front`` and ``on_pressure_front``: whether nothing
        else is both faster and closer. Attributes describe the scene, the reference and its error;
        errors below ``told_apart_to``, the tightest tolerance, count as alike.
    """
    _warm_up(recipe)
    table, ways = _first_runs(scene, recipe)
    again = repeated(
        [way.solve for way in ways],
        [row["seconds"] for row in table if not row["said"]],
        runs=recipe["runs"],
        longest=recipe["longest"],
    )
    for row, runs in zip((row for row in table if not row["said"]), again, strict=True):
        row |= {"seconds": np.median(runs), "seconds_low": min(runs), "seconds_high": max(runs)}
        row["runs"] = len(runs)
    memory = {way.method: way for way in ways if not way.tolerance < DEFAULT_RTOL}
    memory = {method: peak_memory(way.from_scratch) for method, way in memory.items()}
    for row in table:
        row["memory"] = memory.get(row["method"], np.nan)
    result = _labelled(table).assign_attrs(_about_scene(scene))
    # An error smaller than anyone was asked for is no merit, nor one below the reference's own.
    asked = min(recipe["tolerances"])
    result.attrs["told_apart_to"] = max(result.attrs["reference_error"], asked)
    for name, error in FRONTS.items():
        words = f"nothing is both faster and has less {ERRORS[error]}"
        result[name] = ("point", _front(result, error), cf_attrs("1", words))
    return result


def _first_runs(scene, recipe):
    """A row for every way tried, and the ways that gave a state, each run once."""
    dimension = box_dimension(scene.single.state.in_contact, 1.0).dimension
    table, ways = [], []
    for ladder in _ladders(scene, recipe):
        for way in ladder:
            row = {"method": way.method, "kind": way.kind, "tolerance": way.tolerance, "said": ""}
            table.append(row)
            try:
                # Foreign code may crash or never end: it is tried where that does no harm.
                if way.kind == PEER:
                    in_child(way.solve, seconds=peers.PATIENCE)
                raw, row["seconds"] = timed(way.solve)
            except (NotConverged, ChildFailed) as failure:
                row["said"] = str(failure)
                break
            state = way.finish(raw)
            row |= errors_of(state, scene.single, dimension)
            if way.method == OURS:
                row["applications"] = state.iterations
            ways.append(way)
            # A direct method is as close at its loosest tolerance as at any other.
            reached = getattr(state, "residual", np.inf) <= min(recipe["tolerances"])
            too_long = row["seconds"] > recipe["longest"] and way.method != OURS
            if reached or too_long:
                break
    return table, ways


def _ladders(scene, recipe):
    """For every method its ways from loose to tight."""
    height, space, closure = scene.height, scene.space, scene.closure
    tolerances = sorted(recipe["tolerances"], reverse=True)
    for name, press in {OURS: solve_contact, **METHODS}.items():
        if name in SLOW and scene.overlapping > recipe["slow_nodes"]:
            continue
        steps = [np.nan] if name == DIRECT else tolerances
        yield [
            _Way(
                *(name, SOLVER, rtol),
                solve=partial(_cold, press, height, space, closure, rtol),
                finish=_as_it_is,
                from_scratch=partial(_on_a_new_grid, press, height, space, closure, rtol),
            )
            for rtol in steps
        ]
    for name in peers.installed():
        peer = peers.set_up(name, height, space)
        yield [
            _Way(
                *(name, PEER, rtol),
                solve=partial(_press_peer, peer, scene.single, rtol),
                finish=partial(_peer_state, peer, scene),
                from_scratch=partial(_set_up_and_press, name, height, space, scene.single, rtol),
            )
            for rtol in tolerances
        ]
    for name, model in MODELS.items():
        solve = partial(model, height, space, closure=closure)
        from_scratch = partial(_on_a_new_grid, model, height, space, closure, np.nan)
        yield [_Way(name, MODEL, np.nan, solve, _as_it_is, from_scratch)]


def _cold(press, height, space, closure, rtol):
    """A state from nothing: what is kept of the last contact set is dropped."""
    forget_preconditioner(space)
    options = {} if np.isnan(rtol) else {"rtol": rtol}
    return press(height, space, closure=closure, **options)


def _on_a_new_grid(press, height, space, closure, rtol):
    """As `_cold`, kernel and transforms made anew."""
    new = HalfSpace(space.shape, space.spacing, space.modulus, kernel=space.kernel)
    return _cold(press, height, new, closure, rtol)


def _set_up_and_press(name, height, space, reference, rtol):
    return _press_peer(peers.set_up(name, height, space), reference, rtol)


def _as_it_is(state):
    return state


def _press_peer(peer, reference, rtol):
    """Pressure of a peer at the reference's closure, or under its force."""
    if peer.control == "force":
        return peer.solve(reference.force, rtol)
    nodes = np.count_nonzero(reference.state.in_contact)
    return peer.solve(reference.closure, rtol, pixel_force=reference.force / nodes)


def _peer_state(peer, scene, pressure):
    clearance = peers.clearance_of(scene.height)
    load = {peer.control: getattr(scene.single, peer.control)}
    return peers.state_of(scene.space, pressure, clearance, **load)


def _warm_up(recipe):
    """Every method once on a few nodes: compiled code is loaded before the clock starts."""
    _first_runs(HertzScene(16), {**recipe, "tolerances": recipe["tolerances"][:1]})


def errors_of(state, reference, dimension):
    """`ERRORS` of a state.

    Parameters
    ----------
    state : ContactState or CheapState
    reference : Reference
    dimension : float
        Delta_sigma of the reference's contact domain.

    Returns
    -------
    dict
    """
    exact = reference.state
    same = np.array_equal(state.in_contact, exact.in_contact)
    found = dimension if same else box_dimension(state.in_contact, 1.0).dimension
    norm = np.sqrt(np.mean(exact.pressure**2))
    return {
        "force_error": float(reference.error(state)),
        "area_error": abs(state.area / exact.area - 1),
        "delta_error": abs(found - dimension),
        "pressure_error": float(np.sqrt(np.mean((state.pressure - exact.pressure) ** 2)) / norm),
    }


def pareto_front(seconds, error):
    """Which points no other is both faster than and closer than.

    Parameters
    ----------
    seconds, error : (n,) array_like
        A point with a NaN is on no front.

    Returns
    -------
    (n,) bool ndarray
        Of points alike in both all are on the front.
    """
    seconds, error = np.asarray(seconds, float), np.asarray(error, float)
    known = np.isfinite(seconds) & np.isfinite(error)
    no_worse = (seconds <= seconds[:, np.newaxis]) & (error <= error[:, np.newaxis])
    better = (seconds < seconds[:, np.newaxis]) | (error < error[:, np.newaxis])
    return known & ~(no_worse & better & known).any(axis=1)


def _front(points, quantity):
    """The Pareto front of an error; below ``told_apart_to`` no point is the closer one."""
    error = np.maximum(points[quantity].values, points.attrs["told_apart_to"])
    return pareto_front(points["seconds"].values, error)


def ahead_of_ours(points, *, quantity="force_error", below=LEADS_BELOW, models=True):
    """Points of others on the front below an error: where ours is not the fastest way there.

    Parameters
    ----------
    points : xr.Dataset
        From `error_against_time`.
    quantity : str
        A key of `ERRORS`.
    below : float
    models : bool
        Whether the cheaper models count; without them it is a matter of solvers of one problem.

    Returns
    -------
    xr.Dataset
        The points of the front that are not ours.
    """
    if not models:
        points = points.isel(point=np.flatnonzero(points["kind"] != MODEL))
    others = (points[quantity] < below) & (points["method"] != OURS)
    return points.isel(point=np.flatnonzero(_front(points, quantity) & others))


def _labelled(table):
    """The dataset from the rows."""
    words = {
        **{name: cf_attrs("1", text) for name, text in ERRORS.items()},
        "seconds": cf_attrs("s", "wall time of a cold solve, median of the runs"),
        "seconds_low": cf_attrs("s", "wall time, fastest run"),
        "seconds_high": cf_attrs("s", "wall time, slowest run"),
        "runs": cf_attrs("1", "runs"),
        "memory": cf_attrs("B", "peak memory of setting up and solving, on one thread"),
        "applications": cf_attrs("1", f"applications of the operator by {OURS}, on the full grid"),
    }
    texts = {
        "method": cf_attrs("1", "solver or model"),
        "kind": cf_attrs("1", "solver of the package, peer or cheaper model"),
        "said": cf_attrs("1", "what the solver said of its failure"),
    }
    result = xr.Dataset()
    for name, attributes in texts.items():
        result[name] = ("point", np.array([row[name] for row in table], dtype=object), attributes)
    tolerance = [row["tolerance"] for row in table]
    result["tolerance"] = ("point", tolerance, cf_attrs("1", "tolerance asked for"))
    for name, attributes in words.items():
        values = [row.get(name, np.nan) if not row["said"] else np.nan for row in table]
        result[name] = ("point", np.array(values, float), attributes)
    return result


def _about_scene(scene):
    """Attributes: the scene, its reference, and what one application of the operator costs.

    It is one in single precision, as all of ours are but one or two.
    """
    reference, space = scene.single, scene.space
    field = reference.state.pressure.astype(np.float32)
    applied = [timed(partial(space.convolve, field))[1] for _ in range(9)]
    return {
        "scene": scene.name,
        "size": scene.size,
        "hurst": getattr(scene, "hurst", np.nan),
        "contact": getattr(scene, "fraction", np.nan),
        "contact_reached": float(reference.fraction),
        "overlapping": int(scene.overlapping),
        "reference_tolerance": reference.tolerance,
        "reference_error": reference.own_error(scene.height),
        "elimination_error": float(scene.eliminated()),
        "application_seconds": float(np.median(applied)),
        "threads": threads.count(),
        "leads_below": LEADS_BELOW,
    }
