"""Frequency of wrong contact sets where points are dropped alone."""

from _files import write
from engine.job import job

from contactlab.accuracy.elimination import elimination

with job(snakemake) as log:
    given = snakemake.params
    write(elimination(given.draws), snakemake.output[0], log)
