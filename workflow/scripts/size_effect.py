"""Exponents of the size effect, by resolution, size and geometry."""

from _files import read_inputs, write
from engine.job import job

from contactlab.experiments.size_effect_verdict import size_effect_verdict

with job(snakemake) as log:
    given = snakemake.params
    laws = size_effect_verdict(**read_inputs(snakemake.input), recipe=given.recipe)
    write(laws, snakemake.output[0], log)
