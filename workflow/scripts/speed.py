"""Error against time of every solver and cheaper model on one test problem."""

import os

# Read when numpy is imported. Two BLAS threads that wait for each other make a peer's L-BFGS-B four
# times slower; our own threads are another matter.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

from _job import job

from contactlab.accuracy.reference import problems_of
from contactlab.accuracy.speed import error_against_time
from fractalcontact.core import netcdf

with job(snakemake) as log:
    recipe = snakemake.params.recipe
    problem = problems_of(recipe)[snakemake.wildcards.case]
    points = error_against_time(problem, recipe)
    netcdf.write(points, snakemake.output[0])
    log.info("%s", points)
