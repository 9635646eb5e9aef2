"""Stages of a study of accuracy that are made by several functions."""

from collections.abc import Mapping

import xarray as xr

from .convergence import hertz_convergence, punch_convergence, richardson_trials


def convergence(problem: str, recipe: Mapping) -> xr.Dataset:
    """Error against spacing where the solution is known, or trials of Richardson's extrapolation.

    Parameters
    ----------
    problem : {"hertz", "punch", "richardson"}
    recipe : mapping
        The study's ``convergence``.
    """
    if problem == "richardson":
        return richardson_trials(recipe["trials"], recipe["trial_cells"], seed=recipe["seed"])
    converge = {"hertz": hertz_convergence, "punch": punch_convergence}[problem]
    return converge(recipe["cells"], placements=recipe["placements"])
