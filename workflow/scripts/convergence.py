"""Error against spacing where the solution is known, and Richardson's extrapolation."""

from _files import write
from engine.job import job

from contactlab.accuracy.convergence import convergence

with job(snakemake) as log:
    given = snakemake.params
    write(convergence(snakemake.wildcards.problem, given.recipe), snakemake.output[0], log)
