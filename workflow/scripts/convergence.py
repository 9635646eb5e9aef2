"""Error against spacing where the solution is known, or trials of Richardson's extrapolation."""

from _job import job

from fractalcontact.accuracy.convergence import (
    hertz_convergence,
    punch_convergence,
    richardson_trials,
)
from fractalcontact.core import netcdf

with job(snakemake) as log:
    recipe, problem = snakemake.params.recipe, snakemake.wildcards.problem
    if problem == "richardson":
        result = richardson_trials(recipe["trials"], recipe["trial_cells"], seed=recipe["seed"])
    else:
        converge = {"hertz": hertz_convergence, "punch": punch_convergence}[problem]
        result = converge(recipe["cells"], placements=recipe["placements"])
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
