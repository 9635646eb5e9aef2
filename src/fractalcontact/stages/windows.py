"""Size effect of a specimen: its sub-windows solved, and eq. 6 tested on them."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..mechanics.loading import JointLoading
from ..mechanics.states import with_pressure
from ..roughness.dimension import best_dimension
from ..roughness.fit_range import FEWEST_CELLS
from ..size_effect.eq6 import size_test
from ..size_effect.laws import joint_by_size
from ..surface.specimen import cell_side


def window_stages(
    specimens: xr.Dataset,
    surface_dimension: xr.Dataset,
    joints: xr.Dataset,
    settings: Mapping,
    solver: Mapping,
) -> dict[str, xr.Dataset]:
    """Stages that solve sub-windows of one specimen, along its first direction of contact.

    Parameters
    ----------
    specimens, surface_dimension, joints : xr.Dataset
        Of the stages of these names, from :func:`stages.specimen.specimen_stages`.
    settings : mapping
        From :func:`study.configuration.resolve_settings`.
    solver : mapping
        From :func:`study.configuration.solver_settings`.

    Returns
    -------
    dict of str to xr.Dataset
        By stage: windows and size_test.
    """
    direction = settings["contact_directions"][0]
    joint = JointLoading.of_joint(specimens, joints, direction, settings, solver)
    loading = joint.at(np.sort(joint.cells))
    lags = settings["surface_range"]
    if lags is None and np.isfinite(surface_dimension["roll_off"]):
        lags = FEWEST_CELLS * cell_side(specimens), float(surface_dimension["range_max"])
    laws = joint_by_size(loading, best_dimension(surface_dimension), lags)
    stages = {"windows": laws, "size_test": size_test(loading, laws)}
    return {name: with_pressure(stage, joint.area) for name, stage in stages.items()}
