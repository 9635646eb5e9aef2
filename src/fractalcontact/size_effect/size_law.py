"""The well-conditioned form of the size test: contact against b at equal nominal pressure.

A joint without a size effect has the same A_r/A_0, compliance and mean gap in windows of any side b
at one sigma_0. Nothing is inverted here, so that errors of the states come through as they are.
"""

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset
from ..core.intervals import mean_interval
from ..core.limits import CORRECTED_NODES, RESOLVED_NODES
from .division import occupied_windows
from .size_exponents import add_size_exponents, of_usable_sizes, usable_sizes

#: Quantities of sub-windows: name, exponent, fewest nodes of every window of a size, what it is.
WINDOW_QUANTITIES = {
    "area_fraction": ("area_exponent", CORRECTED_NODES, "corrected A_r/A_0"),
    "interface_compliance": ("compliance_exponent", RESOLVED_NODES, "interface compliance"),
    "mean_gap": ("gap_exponent", RESOLVED_NODES, "mean gap"),
}

_OF_SIZE = ("normal_force", "part")
_TABLE = {
    "min_nodes": (_OF_SIZE, "1", "fewest nodes in contact of any sub-window of that size"),
    "edge_ratio": (_OF_SIZE, "1", "compliance of the bulk over that of the interface"),
    "central_load": (
        _OF_SIZE,
        "1",
        "mean load on the central half of the sub-windows over that of an even spread",
    ),
}


def size_law(states: xr.Dataset, domains: np.ndarray | None = None) -> xr.Dataset:
    """Corrected area, compliance and mean gap against b at equal nominal pressure.

    ``states`` and ``domains`` are those of :func:`size_effect.load_ladder.solve_sub_windows`. The
    area counts sub-windows that hold contact of the whole window, all without ``domains``: in a
    gap of the whole's contact a window that is pressed alone touches at another height. Over
    (normal_force, part): :data:`WINDOW_QUANTITIES`, means over the disjoint sub-windows of a size
    with the interval over them, NaN where one of them holds too few nodes; ``min_nodes``,
    ``edge_ratio`` and ``central_load``. Over (normal_force,): ``area_exponent``,
    ``compliance_exponent`` and ``gap_exponent``, by
    :func:`size_effect.size_exponents.add_size_exponents`.
    """
    loads = states.sizes["normal_force"]
    tested = states.isel(step=slice(loads)).rename(step="normal_force")
    dims = ("part", "window", "normal_force")
    nodes = tested["nodes"].isel(resolution=0).transpose(*dims)
    places = [np.arange(n) for n in states["windows"].values]
    compliance = tested["interface_compliance"].transpose(*dims)
    resolved = usable_sizes(nodes.values, RESOLVED_NODES)
    solved = np.isfinite(nodes.values)
    occupied = solved if domains is None else _occupied(tested, domains)
    edge_ratio = (tested["bulk_compliance"] / compliance.mean("window")).values
    result = labelled_dataset(
        _TABLE,
        {
            "min_nodes": nodes.min("window").values.T,
            "edge_ratio": np.where(resolved, edge_ratio, np.nan).T,
            "central_load": tested["central_load"].mean("window").transpose(*_OF_SIZE).values,
        },
        coords={"part": states["part"]},
    ).assign(side=states["side"])
    for name, (exponent, fewest, words) in WINDOW_QUANTITIES.items():
        values = tested[name].transpose(*dims)
        counts = occupied if name == "area_fraction" else solved
        data, of_nodes = (
            np.where(counts, array, np.nan) for array in (values.values, nodes.values)
        )
        values = values.copy(data=of_usable_sizes(data, of_nodes, fewest))
        mean = mean_interval(values.values, axis=1).mapped(np.transpose)
        units = tested[name].attrs["units"]
        result.update(mean.variables(name, _OF_SIZE, units, f"mean {words} of sub-windows"))
        text = f"exponent of {words} against b at equal sigma_0"
        add_size_exponents(result, exponent, values, places, text)
    return result.drop_vars("side")


def _occupied(tested: xr.Dataset, domains: np.ndarray) -> np.ndarray:
    """Sub-windows (part, window, normal_force) that hold contact of the whole window."""
    shape = *(tested.sizes[dim] for dim in ("part", "window")), len(domains)
    occupied = np.zeros(shape, bool)
    for k, parts in enumerate(tested["part"].values):
        for load, domain in enumerate(domains):
            of_size = occupied_windows(domain, int(parts))
            occupied[k, : len(of_size), load] = of_size
    return occupied
