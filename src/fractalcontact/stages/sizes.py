"""Size laws of a specimen from the states of its sub-windows: nothing is solved here."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..roughness.dimension import best_dimension
from ..roughness.fit_range import FEWEST_CELLS
from ..size_effect.laws import joint_by_size
from ..size_effect.prediction import predict_whole_strength
from ..surface.specimen import cell_side


def size_laws_of(
    specimens: xr.Dataset,
    surface_dimension: xr.Dataset,
    window_states: xr.Dataset,
    size_test: xr.Dataset,
    settings: Mapping,
) -> xr.Dataset:
    """Stage windows: roughness, closure and strength over the side b, and what that predicts.

    Parameters
    ----------
    specimens, surface_dimension : xr.Dataset
        Of the stages of these names, from :func:`stages.specimen.specimen_stages`.
    window_states, size_test : xr.Dataset
        From :func:`stages.windows.window_stages`.
    settings : mapping
        From :func:`study.configuration.resolve_settings`.
    """
    lags = settings["surface_range"]
    if lags is None and np.isfinite(surface_dimension["roll_off"]):
        lags = FEWEST_CELLS * cell_side(specimens), float(surface_dimension["range_max"])
    dimension = best_dimension(surface_dimension)
    laws = joint_by_size(window_states, specimens, dimension, lags, settings["material"])
    if laws["direction"].item() == "none":
        return laws
    return laws.merge(predict_whole_strength(laws, size_test["delta_sigma"]))
