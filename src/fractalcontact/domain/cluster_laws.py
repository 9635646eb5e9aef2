"""Laws of contact clusters: number against size, and localisation against offset."""

import numpy as np
import xarray as xr
from scipy import special

from ..core.datasets import labelled
from ..core.determined import follows_law
from ..core.fitting import fit_line
from ..core.limits import CONFIDENCE, RESOLVED_NODES
from ..core.per_curve import per_curve
from ..core.ranges import within

_STATES = ("direction", "offset", "resolution", "normal_force")
_TABLE = {
    "cluster_area": (("resolution", "octave"), "mm2", "smallest cluster of an octave"),
    "clusters_at_least": ((*_STATES, "octave"), "1", "contact clusters of cluster_area or more"),
    "cluster_law_count": (
        (*_STATES, "octave"),
        "1",
        "contact clusters of cluster_area or more by the power law fitted to their sizes",
    ),
    "cluster_law_followed": (
        _STATES,
        "1",
        "whether cluster sizes lie as near to their power law as chance would have them",
    ),
    **{
        f"morisita_by_chance_{end}": (
            _STATES,
            "1",
            f"Morisita's index of as many random nodes, {words} end of 95 % by its scatter",
        )
        for end, words in (("low", "lower"), ("high", "upper"))
    },
    "morisita_used": (_STATES, "1", "state in the fit of morisita_exponent"),
}
_POWERS = {"morisita_exponent": ("1", "x of Morisita's index I ~ v^x over all offsets v")}


def cluster_laws(clusters: xr.Dataset, nodes: np.ndarray, spacing: float) -> xr.Dataset:
    """Sizes of clusters with their power law, and Morisita's index as a power of the offset.

    ``clusters`` has the numbers of :func:`domain.clusters.cluster_statistics` over (direction,
    offset, resolution, normal_force), ``nodes`` the nodes in contact in that order. Only
    Morisita's law leaves out domains of fewer than `RESOLVED_NODES`. ``spacing`` is that of the
    scan, mm.
    """
    cell = (clusters["resolution"] * spacing) ** 2
    area = 2.0 ** clusters["octave"] * cell
    # Counts are summed from the largest clusters down.
    counts = clusters["cluster_octaves"].transpose(..., "octave").values
    # The index of random nodes is 1 in the mean.
    reach = special.ndtri((1 + CONFIDENCE) / 2) * clusters["morisita_scatter"]
    used, powers = localisation(clusters, nodes)
    values = {
        "cluster_area": area,
        "clusters_at_least": np.cumsum(counts[..., ::-1], axis=-1)[..., ::-1],
        "cluster_law_count": _law_count(clusters, area),
        "cluster_law_followed": follows_law(
            clusters["cluster_fit_n"], clusters["cluster_fit_distance"]
        ),
        "morisita_by_chance_low": 1 - reach,
        "morisita_by_chance_high": 1 + reach,
        "morisita_used": used,
    }
    ordered = {
        name: value.transpose(*_TABLE[name][0]).values if hasattr(value, "dims") else value
        for name, value in values.items()
    }
    return xr.Dataset(labelled(_TABLE, ordered) | powers)


def localisation(clusters: xr.Dataset, nodes: np.ndarray) -> tuple[xr.DataArray, dict[str, tuple]]:
    """States in the fit of Morisita's index I ~ v^x, and ``morisita_exponent`` with its interval.

    The arguments are those of :func:`cluster_laws`; of ``clusters`` only ``morisita`` is read.
    """
    offset, index = clusters["offset"], clusters["morisita"]
    used = (offset > 0) & (index > 0) & (xr.zeros_like(index, int) + nodes >= RESOLVED_NODES)
    used_states = {"offset": offset, "index": index.where(used)}
    return used, per_curve(used_states, _power_of_offset, _POWERS, along="offset")


def _law_count(clusters, area):
    """Clusters by the power law of their sizes, from the octave of the smallest one fitted on."""
    smallest, largest = clusters["cluster_fit_min"], clusters["cluster_fit_max"]
    first = area.where(within(area, 0.0, smallest)).max("octave")
    law = clusters["cluster_fit_n"] * (area / first) ** -clusters["cluster_exponent"]
    return law.where(within(area, first, largest))


def _power_of_offset(offset, index):
    """Exponent of Morisita's index as a power of the offset."""
    in_fit = np.isfinite(index)
    return {"morisita_exponent": fit_line(np.log(offset[in_fit]), np.log(index[in_fit])).slope}
