"""Sliding of an ensemble: rigid dilatancy in all directions, and contact at all offsets.

The paper states its results on sliding for two joints. A single joint may show them by chance,
because the few highest points of a face decide. Realisations show what joints of a kind have in
common.
"""

from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset
from ..core.labels import cf_attrs
from ..core.limits import RESOLVED_NODES
from ..core.settings import EnsembleSettings
from ..core.window import window_sides
from ..joint.joint import describe_slide
from ..joint.lag_dimension import lag_dimensions
from ..laws.closure import interface_states
from ..states.loading import JointLoading
from ..states.sweep import contact_states

#: Numbers of every realisation over the offsets, under the reference load: unit, long name.
AT_OFFSETS = {
    "compliance_slid": ("mm/MPa", "compliance of the interface under the reference load"),
    "area_slid": ("1", "A_r / A_0 under the reference load, corrected for the perimeter"),
    "composite_spread": ("mm", "standard deviation sigma_z of the composite topography"),
}
#: Numbers over the offsets and the choices of lags.
OVER_LAGS = ("lag_dimension",)
#: Numbers over the directions, and over the axes of two opposite directions, from the rigid slide.
OF_DIRECTIONS, OF_AXES = ("plateau_slope", "plateau_change"), ("even_change", "odd_slope")

#: Smallest ratio of successive offsets that are solved, as neighbours hardly differ.
OFFSET_RATIO = 1.4

#: Ends of the lags, the same of all realisations.
LAG_ENDS = ("lag_min", "lag_max")

#: Variables whose mean and spread over the realisations are kept.
SLIDING = (*AT_OFFSETS, *OVER_LAGS, *OF_DIRECTIONS, *OF_AXES)


def spread_offsets(cells: np.ndarray) -> np.ndarray:
    """Offsets of a joint, in cells, ascending, at which its realisations are solved.

    Each offset is :data:`OFFSET_RATIO` times the previous one or more; offsets at which the faces
    are flush are left out.
    """
    chosen: list[int] = []
    for n in cells[cells > 0]:
        if not chosen or n >= OFFSET_RATIO * chosen[-1]:
            chosen.append(int(n))
    return np.array(chosen)


def sliding(loading: JointLoading[EnsembleSettings], longest: float) -> xr.Dataset:
    """Sliding of one realisation at the offsets of :func:`spread_offsets`.

    :data:`SLIDING`, with ``plateau_trend`` and ``plateau_undecided`` over (direction,) of
    :func:`joint.plateau.rigid_plateaus`, and the lags of ``lag_dimension``, of which the longest is
    given in mm. Raises `NotConverged`.
    """
    settings, specimen = loading.settings, loading.specimen
    spacing = float(loading.offsets[-1] / loading.cells[-1])
    cells = np.arange(int(loading.cells[-1]) + 1)
    rigid = describe_slide(specimen, settings.directions, cells, spacing)
    names = [*OF_DIRECTIONS, "plateau_trend", "plateau_undecided", *OF_AXES]
    composites = [loading.composite(n) for n in loading.cells]
    lags = lag_dimensions(composites, tuple(loading.spacing), longest)
    return rigid[names].merge(_under_reference_load(loading)).assign(lags)


def _under_reference_load(loading: JointLoading[EnsembleSettings]) -> xr.Dataset:
    """:data:`AT_OFFSETS` of one realisation; missing below ten nodes in contact."""
    finest = min(loading.settings.resolutions)
    light = replace(loading.settings, loads=[loading.settings.map_load])
    states = contact_states(replace(loading, settings=light), [finest], lightly=True)
    window, e_star = window_sides(loading.specimen), light.material.e_star
    curves = interface_states(states, window, e_star).squeeze(
        ["direction", "resolution", "normal_force"]
    )
    many = (curves["nodes"] >= RESOLVED_NODES).values
    values = {
        "compliance_slid": np.where(many, 1 / curves["interface_stiffness"].values, np.nan),
        "area_slid": np.where(many, curves["area_corrected_share"].values, np.nan),
        "composite_spread": curves["composite_spread"].values,
    }
    table = {name: ("offset", *words) for name, words in AT_OFFSETS.items()}
    offset = ("offset", loading.offsets, cf_attrs("mm", "shear offset v"))
    return labelled_dataset(table, values, coords={"offset": offset})
