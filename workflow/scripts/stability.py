"""Verdicts on the solvers by kind of test problem."""

from _files import read_inputs, write
from engine.job import job

from contactlab.accuracy.stability import join

with job(snakemake) as log:
    write(join(**read_inputs(snakemake.input)), snakemake.output[0], log)
