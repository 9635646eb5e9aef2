"""Strength of a specimen, laws of the size of its sub-windows, and verdicts, without a solve."""

from collections.abc import Mapping
from dataclasses import asdict

import numpy as np
import xarray as xr

from ..core.datasets import titled
from ..core.directions import slides
from ..core.settings import ReportSettings, StrengthSettings
from ..core.window import cell_side, nominal_area
from ..laws.strength import joint_strength
from ..roughness.fit_range import MIN_CELLS
from ..roughness.recommended import independent_dimension
from ..size_effect.laws import joint_by_size
from ..size_effect.prediction import predict_whole_strength
from ..statements.comparison import specimen_row
from ..statements.judge import judge
from ..statements.model_validity import model_validity
from ..states.states import with_pressure


@titled(
    windows="closure, roughness and strength of sub-windows against their size",
    strength="dilatancy and friction angles, shear strength",
    elastic_model=(
        "verdict on the elastic model: real mean pressure against strength, slope of the faces"
    ),
    statements="the paper's statements, and their verdicts",
    comparison="quantities of a specimen for comparison with others, with their errors",
)
def strength_stages(settings: ReportSettings, **stages: xr.Dataset) -> dict[str, xr.Dataset]:
    """Stages that solve nothing: a friction angle, wall strength or label makes these alone again.

    ``stages`` are those that the rule ``strength`` takes, of one specimen, by name. A joint that
    does not slide has no stage strength.
    """
    laws = size_and_strength(stages, settings)
    every, stated = stages | laws, asdict(settings)
    return {
        **laws,
        "elastic_model": model_validity(every["area"], every["scaling"], settings.material),
        "statements": judge(every, stated),
        "comparison": specimen_row(every, stated),
    }


def size_and_strength(
    stages: Mapping[str, xr.Dataset], settings: StrengthSettings
) -> dict[str, xr.Dataset]:
    """Stage windows (laws over the side b) and, of a joint that slides, stage strength."""
    specimens, laws = stages["specimens"], _size_laws(stages, settings)
    results = {"windows": laws}
    if slides(specimens.attrs["opposite"]):
        whole = predict_whole_strength(laws, stages["size_test"]["delta_sigma"])
        results["windows"] = laws.merge(whole)
        results["strength"] = joint_strength(
            stages["dilatancy"], stages["joints"], specimens, settings
        )
    area = nominal_area(specimens)
    return {name: with_pressure(stage, area) for name, stage in results.items()}


def _size_laws(stages: Mapping[str, xr.Dataset], settings: StrengthSettings) -> xr.Dataset:
    """Size laws, fitted below a roll-off where there is one."""
    surface, specimens = stages["surface_dimension"], stages["specimens"]
    lags = settings.surface_range
    if lags is None and np.isfinite(surface["roll_off"]):
        lags = MIN_CELLS * cell_side(specimens), float(surface["range_max"])
    dimension = independent_dimension(surface)
    return joint_by_size(stages["window_states"], specimens, dimension, lags, settings.material)
