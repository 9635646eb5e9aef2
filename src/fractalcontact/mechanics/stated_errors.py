"""Errors that the stages state for their states: the largest and the median of all offsets."""

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset
from ..core.labels import cf_attrs
from .states import SOLVER_ERROR

#: Change of the closure by twice the spacing, which is no solver error: of another surface.
SPACING = "closure: change by twice the spacing"
#: Quantities: stage, variable, its error, and whether that is a fraction of the value.
_ERRORS = {
    "interface closure": ("closure", "interface_closure", "interface_closure_error", True),
    "real contact area": ("closure", "area", "area_error", True),
    "interface stiffness": ("closure", "interface_stiffness", "interface_stiffness_error", True),
    # It may be zero.
    "Delta_sigma by box counting": ("domains", "delta_sigma", "delta_sigma_error", False),
    SPACING: ("closure", "interface_closure", "closure_spacing_error", True),
}
_WORDS = f"{SOLVER_ERROR} of a quantity, or change by twice the spacing"
_EACH = ("quantity", "normal_force")
_TABLE = {
    "median_error": (_EACH, "1", f"median over the offsets: {_WORDS}"),
    "largest_error": (_EACH, "1", f"largest over the offsets: {_WORDS}"),
    "offsets_with_error": (_EACH, "1", "offsets whose error is known"),
    "error_kind": ("quantity", "1", "relative, a fraction of the quantity, or absolute"),
    "error_is_by_solver": ("quantity", "1", "whether errors are the solver's, else by the spacing"),
}


def stated_errors(closure: xr.Dataset, domains: xr.Dataset, direction: str) -> xr.Dataset:
    """Errors of a quantity over the offsets under each load, at the finest resolution.

    Parameters
    ----------
    closure, domains : xr.Dataset
        Stages of these names.
    direction : str

    Returns
    -------
    xr.Dataset
        The variables of :data:`_TABLE` over (quantity, normal_force).
    """
    finest = {
        name: stage.sel(direction=direction).sel(resolution=stage["resolution"].min())
        for name, stage in (("closure", closure), ("domains", domains))
    }
    found: dict[str, list[list[float]]] = {name: [] for name in _TABLE if _TABLE[name][0] == _EACH}
    for stage, variable, key, relative in _ERRORS.values():
        states = finest[stage]
        size = abs(states[variable]) if relative else xr.ones_like(states[variable])
        # Where nodes yield the stiffness has a scatter of its own, which is none of the solver's.
        bound = states[key] - states.get(key.replace("_error", "_scatter"), 0.0)
        errors = (bound / size.where(size > 0)).transpose("offset", "normal_force").values
        known = [one[np.isfinite(one)] for one in errors.T]
        found["median_error"].append([np.median(one) if one.size else np.nan for one in known])
        found["largest_error"].append([one.max() if one.size else np.nan for one in known])
        found["offsets_with_error"].append([one.size for one in known])
    values = found | {
        "error_kind": ["relative" if one[-1] else "absolute" for one in _ERRORS.values()],
        "error_is_by_solver": [name != SPACING for name in _ERRORS],
    }
    words = cf_attrs("1", "quantity whose errors are stated")
    coords = {
        "quantity": ("quantity", list(_ERRORS), words),
        "normal_force": closure["normal_force"],
    }
    return labelled_dataset(_TABLE, values, coords)
