"""The flow of a joint that crushes, whose coarsest grid need not be that of its scan."""

import numpy as np
import pytest
from chain import SMALL_STUDY, SOLVER
from made_stages import scan, stages_of
from materials import ROCK

from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.synthesis import self_affine


@pytest.mark.parametrize("resolutions", [[1, 2], [2, 4]])
def test_what_has_crushed_unloads_on_the_reported_grid(resolutions):
    own = {
        "material": ROCK | {"hardness": "80 MPa"},
        "loads": ["1 MPa", "5 MPa", "10 MPa"],
        "resolutions": resolutions,
        "offsets": ["0.4 mm"],
    }
    settings = resolve_settings(SMALL_STUDY, None, own, "made")
    face = scan(self_affine((96, 96), 0.1, 0.8, rms=0.05, seed=1), 0.1)
    stages = stages_of(
        "capped", (face, None), settings, SOLVER, later=("window_states", "closure", "flow")
    )
    flow = stages["flow"]
    assert (stages["branches"]["permanent_set"] > 0).any()
    assert flow.sizes["flow_x"] == stages["joints"].sizes["window_x"] // resolutions[0]
    gap = flow["branch_mean_gap"].sel(branch="reload").values
    known = np.isfinite(gap)
    assert known.sum() > 1
    # What has been pressed in leaves less of a gap than there was at the same load before.
    loaded = flow["branch_mean_gap"].sel(branch="load").values[known]
    assert (gap[known] <= loaded * (1 + 1e-6)).all()
    assert (gap[known][:-1] < loaded[:-1]).any()
