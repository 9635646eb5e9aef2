"""Which method solves which kind of scene: right, an honest failure, or silently wrong."""

import numpy as np
import xarray as xr

from . import methods
from .contact import NotConverged, solve_contact
from .hard_scenes import KINDS, hard_scene
from .labels import about
from .scenes import violation

RTOL = 1e-6
#: A state is right if it violates the conditions by no more than this many times the tolerance:
#: methods judge themselves with other roundings than the judge.
MARGIN = 2.0
#: And if its force (its closure, where the force was given) is that of direct elimination.
AGREEMENT = 1e-4

#: Verdicts, in the order of their codes.
VERDICTS = ("right", "honest failure", "silently wrong", "not offered")
RIGHT, HONEST, SILENT, NOT_OFFERED = range(len(VERDICTS))
#: What a method says of a load it was not made for.
_NOT_MADE_FOR = ("a closure only", "knows no hardness")


def solvers():
    """Every solver by name: ours first, then those kept for comparison."""
    return {"fractalcontact": solve_contact, **methods.METHODS}


def stability(name, kinds=None, draws=25):
    """Verdicts on one solver.

    Parameters
    ----------
    name : str
        A key of `solvers`.
    kinds : list of str, optional
        Keys of `hard_scenes.KINDS`; all by default.
    draws : int
        Scenes of each kind.

    Returns
    -------
    xr.Dataset
        On (solver, kind, draw): ``verdict``, an index into `VERDICTS`; ``violation`` of the contact
        conditions as a share of the closure, and ``disagreement`` with direct elimination, NaN
        where no state was returned; ``said``, what the solver said of a failure.
        ``hard_scene(kind, draw)`` makes the scene again.
    """
    kinds = list(KINDS) if kinds is None else kinds
    found = [[_judge(name, hard_scene(kind, draw)) for draw in range(draws)] for kind in kinds]
    codes = ", ".join(f"{code} {verdict}" for code, verdict in enumerate(VERDICTS))
    fields = {
        "verdict": ("int8", about("1", codes)),
        "violation": (
            float,
            about("1", "largest violation of the conditions, share of the closure"),
        ),
        "disagreement": (
            float,
            about("1", "force, or closure, less that of elimination, relative"),
        ),
        "said": (object, about("1", "what the solver said")),
    }
    dims = ("solver", "kind", "draw")
    result = xr.Dataset(
        coords={"solver": [name], "kind": kinds, "draw": np.arange(draws)},
        attrs={"rtol": RTOL, "margin": MARGIN, "agreement": AGREEMENT},
    )
    for place, (key, (dtype, attributes)) in enumerate(fields.items()):
        values = [[[scene[place] for scene in row] for row in found]]
        result[key] = dims, np.array(values, dtype=dtype), attributes
    return result


def _judge(name, scene):
    """Verdict, violation, disagreement and what the solver said."""
    nothing = (np.nan, np.nan)
    try:
        state = solvers()[name](scene.height, scene.space, rtol=RTOL, **scene.load)
    except (NotConverged, ValueError) as error:
        said = str(error)
        if any(words in said for words in _NOT_MADE_FOR):
            return NOT_OFFERED, *nothing, said
        return (HONEST if scene.solvable else RIGHT), *nothing, said
    if not scene.solvable:
        return SILENT, *nothing, "a state where there is none"
    if state.closure == 0:
        unloaded = not any(scene.load.get(control) for control in ("closure", "force"))
        return (RIGHT if unloaded and not state.pressure.any() else SILENT), 0.0, 0.0, ""
    wrong, rounding = violation(state, np.asarray(scene.height, float))
    apart = _disagreement(state, scene)
    right = wrong <= MARGIN * RTOL + rounding and not apart > AGREEMENT
    return (RIGHT if right else SILENT), wrong, apart, ""


def _disagreement(state, scene):
    """How far force, or closure, is from that of direct elimination; NaN where that fails."""
    load = {key: value for key, value in scene.load.items() if key != "start"}
    try:
        exact = methods.METHODS["dense"](scene.height, scene.space, **load)
    except NotConverged:
        return np.nan
    by_force = "force" in load
    ours, theirs = (state.closure, exact.closure) if by_force else (state.force, exact.force)
    return abs(ours / theirs - 1)
