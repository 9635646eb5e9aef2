"""Sub-windows of a specimen solved: their states, and eq. 6 tested on them."""

import numpy as np
import xarray as xr

from ..core.datasets import titled
from ..core.settings import Solver, WindowSettings
from ..size_effect import windows
from ..size_effect.division import divisions
from ..size_effect.eq6 import size_test
from ..states.loading import JointLoading
from ..states.states import with_pressure


@titled(
    window_states="contact states of sub-windows, one by one",
    size_test=(
        "contact against size at equal nominal pressure, eq. 6's own form, and the whole predicted"
    ),
)
def window_stages(
    specimens: xr.Dataset, joints: xr.Dataset, settings: WindowSettings, solver: Solver
) -> dict[str, xr.Dataset]:
    """Stages window_states and size_test, along the first direction of contact.

    What needs no solve is left to :func:`stages.strength.strength_stages`, so that a new friction
    angle solves nothing again.
    """
    direction = settings.contact_directions[0]
    joint = JointLoading.of_joint(specimens, joints, direction, settings, solver)
    loading = joint.at(np.sort(joint.cells))
    stages = {
        "window_states": windows.window_states(loading, divisions(loading.shape)),
        "size_test": size_test(loading),
    }
    return {name: with_pressure(stage, joint.area) for name, stage in stages.items()}
