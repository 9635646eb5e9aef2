"""How the time and the memory of every solver grow with the size of the grid."""

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.intervals import INTERVAL
from ..core.labels import cf_attrs
from .speed import MODEL, OURS

#: Nodes of the grid, not nodes a side, are what time and memory are fitted against.
FITTED = {"seconds": "wall time", "memory": "peak memory"}


def growth(scenes, error):
    """Time and memory over sizes at an error of the force, with the exponents of their growth.

    Parameters
    ----------
    scenes : list of xr.Dataset
        From `speed.error_against_time`; one surface at several sizes, and several surfaces.
    error : float
        A solver counts at the tolerance with which it gets there fastest.

    Returns
    -------
    xr.Dataset
        On (surface, solver, size): ``seconds``, ``memory`` (B) and ``reached``, the error of the
        force. On (surface, solver): ``seconds_exponent`` and ``memory_exponent`` in the number of
        nodes, with ``_low`` and ``_high`` (95 %; NaN with fewer than three sizes). On (surface,
        size), of ours at that tolerance: ``bound``, seconds of its applications of the operator
        alone, in single precision.
    """
    surfaces = list(dict.fromkeys(_surface(scene) for scene in scenes))
    sizes = sorted({scene.attrs["size"] for scene in scenes})
    solvers = list(
        dict.fromkeys(
            str(name)
            for scene in scenes
            for name in scene["method"].values[scene["kind"].values != MODEL]
        )
    )
    shape = (len(surfaces), len(solvers), len(sizes))
    table = {name: np.full(shape, np.nan) for name in (*FITTED, "reached")}
    bound = np.full((len(surfaces), len(sizes)), np.nan)
    for scene in scenes:
        i, k = surfaces.index(_surface(scene)), sizes.index(scene.attrs["size"])
        for j, solver in enumerate(solvers):
            fastest = _fastest(scene, solver, error)
            if fastest is not None:
                table["seconds"][i, j, k] = fastest["seconds"]
                table["memory"][i, j, k] = fastest["memory"]
                table["reached"][i, j, k] = fastest["force_error"]
                if solver == OURS:
                    bound[i, k] = fastest["applications"] * scene.attrs["application_seconds"]
    dims = ("surface", "solver", "size")
    result = xr.Dataset(
        {
            "seconds": (dims, table["seconds"], cf_attrs("s", "wall time at the error asked for")),
            "memory": (dims, table["memory"], cf_attrs("B", "peak memory of a solve")),
            "reached": (dims, table["reached"], cf_attrs("1", "error of the force, relative")),
            "bound": (
                ("surface", "size"),
                bound,
                cf_attrs("s", f"applications of the operator by {OURS}, alone"),
            ),
        },
        coords={
            "surface": ("surface", surfaces, cf_attrs("1", "scene without its size")),
            "solver": ("solver", solvers, cf_attrs("1", "solver of the package, or peer")),
            "size": ("size", sizes, cf_attrs("1", "nodes a side")),
        },
        attrs={"error": error},
    )
    nodes = np.log(np.square(sizes, dtype=float))
    for name, words in FITTED.items():
        lines = [fit_line(nodes, np.log(values)) for values in table[name].reshape(-1, len(sizes))]
        for ending, which in zip(INTERVAL, ("slope", "slope_low", "slope_high"), strict=True):
            slopes = np.reshape([getattr(line, which) for line in lines], shape[:2])
            text = f"exponent of the {words} in the number of nodes{INTERVAL[ending]}"
            result[f"{name}_exponent{ending}"] = (dims[:2], slopes, cf_attrs("1", text))
    return result


def _surface(scene):
    """Name of a scene without its size."""
    return scene.attrs["scene"].split(", ", 1)[1]


def _fastest(scene, solver, error):
    """The fastest point of a solver with no more than an error; None if it has none."""
    good = (scene["method"] == solver) & (scene["force_error"] <= error)
    if not good.any():
        return None
    chosen = scene.isel(point=np.flatnonzero(good))
    return chosen.isel(point=int(chosen["seconds"].values.argmin()))
