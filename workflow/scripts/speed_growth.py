"""Time and memory of the solvers over sizes."""

from _files import read_inputs, write
from engine.job import job

from contactlab.accuracy.growth import growth

with job(snakemake) as log:
    given = snakemake.params
    write(growth(**read_inputs(snakemake.input), error=given.error), snakemake.output[0], log)
