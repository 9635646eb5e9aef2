"""Error against time of solvers and cheaper models on a test problem."""

from _files import write
from engine.job import job

from contactlab.accuracy.speed import speed

with job(snakemake) as log:
    given = snakemake.params
    write(speed(snakemake.wildcards.scene, given.recipe), snakemake.output[0], log)
