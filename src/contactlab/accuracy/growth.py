"""Growth of the time and the memory of every solver with the size of the grid."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled_dataset, titled
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.fitting import fit_line
from fractalcontact.core.labels import cf_attrs

from .speed import MODEL, OURS

#: Quantities fitted against the number of nodes of the grid (not nodes per side).
FITTED = {"seconds": "wall time", "memory": "peak memory"}
_DIMS = ("surface", "solver", "size")
#: Variables of `growth`: dimensions, unit, long name.
_GROWTH = {
    "seconds": (_DIMS, "s", "wall time at the requested error"),
    "memory": (_DIMS, "B", "peak memory of a solve"),
    "reached": (_DIMS, "1", "error of the force, relative"),
    "bound": (("surface", "size"), "s", f"applications of the operator by {OURS}, alone"),
}


@titled("time and memory of the solvers over sizes")
def growth(problems: Sequence[xr.Dataset], error: float) -> xr.Dataset:
    """Time and memory over sizes at an error of the force, with the exponents of their growth.

    Parameters
    ----------
    problems : list of xr.Dataset
        From `speed.error_against_time`; one surface at several sizes, and several surfaces.
    error : float
        Error of the force; each solver is taken at the tolerance that reaches it fastest.

    Returns
    -------
    xr.Dataset
        On (surface, solver, size): ``seconds``, ``memory`` (B) and ``reached``, the error of the
        force. On (surface, solver): ``seconds_exponent`` and ``memory_exponent`` in the number of
        nodes, with ``_low`` and ``_high`` (95 %; NaN with fewer than three sizes). On (surface,
        size), of ours at that tolerance: ``bound``, seconds of its applications of the operator
        alone, in single precision.
    """
    surfaces = list(dict.fromkeys(_surface(problem) for problem in problems))
    sizes = sorted({problem.attrs["size"] for problem in problems})
    solvers = list(
        dict.fromkeys(
            str(name)
            for problem in problems
            for name in problem["method"].values[problem["kind"].values != MODEL]
        )
    )
    shape = (len(surfaces), len(solvers), len(sizes))
    values = _at_error(problems, error, surfaces, solvers, sizes)
    result = labelled_dataset(
        _GROWTH,
        values,
        coords={
            "surface": ("surface", surfaces, cf_attrs("1", "test problem without its size")),
            "solver": ("solver", solvers, cf_attrs("1", "solver of the package, or peer")),
            "size": ("size", sizes, cf_attrs("1", "nodes per side")),
        },
        attrs={"error": error},
    )
    nodes = np.log(np.square(sizes, dtype=float))
    for name, words in FITTED.items():
        lines = (fit_line(nodes, np.log(row)).slope for row in values[name].reshape(-1, len(sizes)))
        words = f"exponent of the {words} in the number of nodes"
        exponents = Estimate.stack(lines, shape[:2])
        result.update(exponents.variables(f"{name}_exponent", _DIMS[:2], "1", words))
    return result


def _at_error(problems, error, surfaces, solvers, sizes):
    """Values of `_GROWTH`, NaN where a solver does not reach the error."""
    shape = (len(surfaces), len(solvers), len(sizes))
    values = {name: np.full(shape, np.nan) for name in (*FITTED, "reached")}
    values["bound"] = np.full((len(surfaces), len(sizes)), np.nan)
    for problem in problems:
        i, k = surfaces.index(_surface(problem)), sizes.index(problem.attrs["size"])
        for j, solver in enumerate(solvers):
            fastest = _fastest(problem, solver, error)
            if fastest is not None:
                values["seconds"][i, j, k] = fastest["seconds"]
                values["memory"][i, j, k] = fastest["memory"]
                values["reached"][i, j, k] = fastest["force_error"]
                if solver == OURS:
                    seconds = problem.attrs["application_seconds"]
                    values["bound"][i, k] = fastest["applications"] * seconds
    return values


def _surface(problem):
    """Name of a test problem without its size."""
    return problem.attrs["scene"].split(", ", 1)[1]


def _fastest(problem, solver, error):
    """Fastest point of a solver within an error; None if no point is."""
    good = (problem["method"] == solver) & (problem["force_error"] <= error)
    if not good.any():
        return None
    chosen = problem.isel(point=np.flatnonzero(good))
    return chosen.isel(point=int(chosen["seconds"].values.argmin()))
