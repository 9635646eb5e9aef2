"""Verdicts on the solvers for some kinds of test problem."""

from _files import write
from engine.job import job

from contactlab.accuracy.stability import stability

with job(snakemake) as log:
    given = snakemake.params
    write(stability(given.kinds, given.draws), snakemake.output[0], log)
