"""Strength of sliding mated joints over their side."""

from _files import write
from engine.job import job

from contactlab.experiments.size_strength import size_strength

with job(snakemake) as log:
    given = snakemake.params
    write(size_strength(given.recipe, given.rtol), snakemake.output[0], log)
