"""Which method solves which kind of scene: right, an honest failure, or silently wrong."""

import numpy as np
import xarray as xr

from ..contact.solve import solve_contact
from ..core.errors import NotConverged
from ..core.labels import cf_attrs
from ..methods import registry as methods
from ..methods.peers import peer_methods
from .hard_problems import KINDS, hard_scene
from .random_problems import violation

RTOL = 1e-6
#: A state is right if it violates the conditions by no more than this many times the tolerance:
#: methods judge themselves with other roundings than the judge.
MARGIN = 2.0
#: And if its force (its closure, where the force was given) is that of direct elimination.
AGREEMENT = 1e-4
#: Tolerances that a peer is given one after the other while its state is not right: they are on
#: quantities of its own, and to have met them is not to be silently wrong.
PEER_RTOLS = (RTOL, 1e-8, 1e-10, 1e-12, 1e-14)

#: Verdicts, in the order of their codes.
VERDICTS = ("right", "honest failure", "silently wrong", "not offered")
RIGHT, HONEST, SILENT, NOT_OFFERED = range(len(VERDICTS))
#: What a method says of a load it was not made for.
_NOT_MADE_FOR = ("a closure only", "a force only", "knows no hardness", "solves another problem")
#: How the package's solvers say that they failed; public codes raise whatever they raise.
_OWN_WORDS = (NotConverged, ValueError)


def solvers():
    """Every solver by name: ours first, those kept for comparison, public codes if installed."""
    return {"fractalcontact": solve_contact, **methods.METHODS, **peer_methods()}


def stability(kinds=None, draws=25):
    """Verdicts on every solver.

    Parameters
    ----------
    kinds : list of str, optional
        Keys of `hard_scenes.KINDS`; all by default.
    draws : int
        Scenes of each kind.

    Returns
    -------
    xr.Dataset
        On (kind, draw, solver): ``verdict``, an index into `VERDICTS`; ``violation`` of the contact
        conditions as a share of the closure, and ``disagreement`` with direct elimination, NaN
        where no state was returned; ``asked``, the tolerance at which it was judged: of peers one
        of `PEER_RTOLS`; ``said``, what the solver said of a failure.
        ``hard_scene(kind, draw)`` makes the scene again.
    """
    kinds = list(KINDS) if kinds is None else list(kinds)
    judged = solvers()
    found = [
        [_judge_all(judged, hard_scene(kind, draw)) for draw in range(draws)] for kind in kinds
    ]
    codes = ", ".join(f"{code} {verdict}" for code, verdict in enumerate(VERDICTS))
    fields = {
        "verdict": ("int8", cf_attrs("1", codes)),
        "violation": (
            float,
            cf_attrs("1", "largest violation of the conditions, share of closure"),
        ),
        "disagreement": (float, cf_attrs("1", "relative difference from direct elimination")),
        "asked": (float, cf_attrs("1", "tolerance asked for")),
        "said": (object, cf_attrs("1", "what the solver said")),
    }
    result = xr.Dataset(
        coords={"kind": kinds, "draw": np.arange(draws), "solver": list(judged)},
        attrs={
            "rtol": RTOL,
            "margin": MARGIN,
            "agreement": AGREEMENT,
            "tightest": min(PEER_RTOLS),
        },
    )
    for place, (name, (dtype, attributes)) in enumerate(fields.items()):
        values = [[[verdict[place] for verdict in scene] for scene in row] for row in found]
        result[name] = ("kind", "draw", "solver"), np.array(values, dtype=dtype), attributes
    return result


def join(parts):
    """Verdicts on all kinds of scene, in the order of `hard_scenes.KINDS`.

    Parameters
    ----------
    parts : sequence of xr.Dataset
        From `stability`, of different kinds.

    Returns
    -------
    xr.Dataset
    """
    whole = xr.concat(parts, "kind", data_vars="minimal")
    return whole.sel(kind=[kind for kind in KINDS if kind in whole["kind"]])


def _judge_all(judged, scene):
    """Every solver on one scene."""
    exact = _exact(scene)
    foreign = peer_methods()
    return [
        _judge_patiently(solve, scene, exact, PEER_RTOLS, Exception)
        if name in foreign
        else _judge_patiently(solve, scene, exact, (RTOL,), _OWN_WORDS)
        for name, solve in judged.items()
    ]


def _judge_patiently(solve, scene, exact, tolerances, failures):
    """The verdict at the first tolerance where a solver is not silently wrong, or at the last."""
    for rtol in tolerances:
        verdict, wrong, apart, said = _judge(solve, scene, exact, rtol, failures)
        if verdict != SILENT or not scene.solvable:
            break
    return verdict, wrong, apart, rtol, said


def _exact(scene):
    """Force, or closure where the force is given, by direct elimination; NaN where that fails."""
    load = {key: value for key, value in scene.load.items() if key != "start"}
    try:
        state = methods.METHODS["dense"](scene.height, scene.space, **load)
    except (NotConverged, ValueError):
        return np.nan
    return _answer(state, scene)


def _answer(state, scene):
    return state.closure if "force" in scene.load else state.force


def _judge(solve, scene, exact, rtol, failures):
    """Verdict, violation, disagreement and what the solver said."""
    nothing = (np.nan, np.nan)
    try:
        state = solve(scene.height, scene.space, rtol=rtol, **scene.load)
    except failures as error:
        said = str(error) or type(error).__name__
        if any(words in said for words in _NOT_MADE_FOR):
            return NOT_OFFERED, *nothing, said
        return (HONEST if scene.solvable else RIGHT), *nothing, said
    if not scene.solvable:
        return SILENT, *nothing, "a state where there is none"
    if state.closure == 0:
        unloaded = not any(scene.load.get(control) for control in ("closure", "force"))
        return (RIGHT if unloaded and not state.pressure.any() else SILENT), 0.0, 0.0, ""
    wrong, rounding = violation(state, np.asarray(scene.height, float))
    apart = abs(_answer(state, scene) / exact - 1)
    right = wrong <= MARGIN * RTOL + rounding and not apart > AGREEMENT
    return (RIGHT if right else SILENT), wrong, apart, ""
