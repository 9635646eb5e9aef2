"""Error budget of a specimen, and with it what was solved and how exactly."""

from collections.abc import Mapping

import xarray as xr

from ..accuracy.error_budget import error_budget
from ..core.labels import cf_attrs
from ..mechanics.loading import JointLoading
from ..mechanics.plan import solve_plan
from ..mechanics.registration_spread import registration_spread
from ..mechanics.states import with_pressure
from ..study.configuration import solver_settings


def error_stages(
    specimens: xr.Dataset,
    joints: xr.Dataset,
    closure: xr.Dataset,
    dilatancy: xr.Dataset,
    domains: xr.Dataset,
    settings: Mapping,
    solver: Mapping,
) -> dict[str, xr.Dataset]:
    """Stages that solve some states again on finer grids, along the first direction of contact.

    Parameters
    ----------
    specimens, joints, closure, dilatancy, domains : xr.Dataset
        Of the stages of these names.
    settings : mapping
        From :func:`study.configuration.resolve_settings`.
    solver : mapping
        From :func:`study.configuration.solver_settings`.

    Returns
    -------
    dict of str to xr.Dataset
        By stage: error_budget and choices.
    """
    direction = settings["contact_directions"][0]
    joint = JointLoading.of_joint(specimens, joints, direction, settings, solver)
    loading = joint.at_map_offset()
    spread = registration_spread(loading)
    budget = error_budget(loading, closure, domains, registration_spread=spread)
    return {
        "error_budget": with_pressure(budget, joint.area),
        "choices": solve_plan(closure, dilatancy, settings, solver, budget).assign(asked(solver)),
    }


def asked(solver: Mapping) -> dict[str, tuple]:
    """Error of the closure that the study asks for, as ``xr.Dataset`` takes it.

    All states, at full cost, ask nothing of the grid: the usual error stands for it.
    """
    accuracy = solver["accuracy"] or solver_settings({}, "")["accuracy"]
    words = cf_attrs("1", "error of the closure that the study asks for, a fraction")
    return {"closure_accuracy": ((), accuracy["closure"], words)}
