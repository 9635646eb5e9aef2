"""Error against spacing where the solution is known, or trials of Richardson's extrapolation."""

from _job import job

from contactlab.accuracy.stage import convergence
from fractalcontact.core import netcdf

with job(snakemake) as log:
    result = convergence(snakemake.wildcards.problem, snakemake.params.recipe)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
