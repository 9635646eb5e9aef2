"""Strength of a specimen, and the effect of the side of its sub-windows, without a solve."""

import numpy as np
import xarray as xr

from ..core.directions import slides
from ..core.settings import StrengthSettings
from ..core.window import cell_side, nominal_area
from ..laws.strength import joint_strength
from ..roughness.fit_range import MIN_CELLS
from ..roughness.recommended import best_dimension
from ..size_effect.laws import joint_by_size
from ..size_effect.prediction import predict_whole_strength
from ..states.states import with_pressure


def strength_stages(
    specimens: xr.Dataset,
    surface_dimension: xr.Dataset,
    joints: xr.Dataset,
    window_states: xr.Dataset,
    size_test: xr.Dataset,
    dilatancy: xr.Dataset,
    settings: StrengthSettings,
) -> dict[str, xr.Dataset]:
    """Stages that read friction angles, so that a change of one makes no others again.

    Parameters
    ----------
    specimens, surface_dimension, joints : xr.Dataset
        Of the stages of these names, from :func:`stages.specimen.specimen_stages`.
    window_states, size_test : xr.Dataset
        Likewise, from :func:`stages.windows.window_stages`.
    dilatancy : xr.Dataset
        From :func:`stages.states.state_stages`.
    settings : StrengthSettings

    Returns
    -------
    dict of str to xr.Dataset
        By stage: windows (roughness, closure and strength over the side b) and, of a joint that
        slides, strength.
    """
    laws = _size_laws(specimens, surface_dimension, window_states, settings)
    stages = {"windows": laws}
    if slides(specimens.attrs["opposite"]):
        stages["windows"] = laws.merge(predict_whole_strength(laws, size_test["delta_sigma"]))
        stages["strength"] = joint_strength(dilatancy, joints, specimens, settings)
    area = nominal_area(specimens)
    return {name: with_pressure(stage, area) for name, stage in stages.items()}


def _size_laws(
    specimens: xr.Dataset,
    surface_dimension: xr.Dataset,
    window_states: xr.Dataset,
    settings: StrengthSettings,
) -> xr.Dataset:
    """Size laws, fitted below a roll-off where there is one."""
    lags = settings.surface_range
    if lags is None and np.isfinite(surface_dimension["roll_off"]):
        lags = MIN_CELLS * cell_side(specimens), float(surface_dimension["range_max"])
    dimension = best_dimension(surface_dimension)
    return joint_by_size(window_states, specimens, dimension, lags, settings.material)
