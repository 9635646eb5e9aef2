"""Stages that take further solves: branches, error budget, and the plan of what was solved."""

import xarray as xr

from ..core.labels import cf_attrs
from ..core.settings import Solver, StateSettings
from ..core.tolerance import ACCURACY
from ..core.units import share_of
from ..error_budget.error_budget import error_budget
from ..laws.branches import joint_branches
from ..states.loading import JointLoading
from ..states.plan import solve_plan
from ..states.registration_spread import registration_spread
from ..states.scan_spread import scan_spread
from ..states.states import with_pressure


def error_stages(
    specimens: xr.Dataset,
    joints: xr.Dataset,
    closure: xr.Dataset,
    dilatancy: xr.Dataset,
    domains: xr.Dataset,
    mapped: xr.Dataset,
    settings: StateSettings,
    solver: Solver,
    ensemble: xr.Dataset | None = None,
) -> dict[str, xr.Dataset]:
    """Stages that solve some states again on finer grids, along the first direction of contact.

    Parameters
    ----------
    specimens, joints, closure, dilatancy, domains : xr.Dataset
        Of the stages of these names.
    mapped : xr.Dataset
        Fields of the states at the offset of the maps, from :func:`states.states.map_states`.
    settings : StateSettings
    solver : Solver
    ensemble : xr.Dataset, optional
        Stage of this name.

    Returns
    -------
    dict of str to xr.Dataset
        By stage: branches, error_budget and choices.
    """
    direction = settings.contact_directions[0]
    joint = JointLoading.of_joint(specimens, joints, direction, settings, solver)
    loading = joint.at_map_offset()
    budget = error_budget(
        loading,
        closure,
        domains,
        registration_spread=registration_spread(loading),
        scan_spread=scan_spread(loading),
        ensemble=ensemble,
    )
    plan = solve_plan(closure, dilatancy, solver, budget)
    return {
        "branches": joint_branches(loading, closure, mapped),
        "error_budget": with_pressure(budget, joint.area),
        "choices": plan.assign(asked(solver)),
    }


def asked(solver: Solver) -> dict[str, tuple]:
    """Error of the closure that the study asks for, as ``xr.Dataset`` takes it.

    All states, at full cost, ask nothing of the grid: the usual error stands for it.
    """
    asks = solver.accuracy["closure"] if solver.accuracy else share_of(ACCURACY["closure"])
    words = cf_attrs("1", "requested error of the closure, a fraction")
    return {"closure_accuracy": ((), asks, words)}
