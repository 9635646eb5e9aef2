"""Rigid dilatancy of synthetic joints with and without a roll-off."""

from _files import write
from engine.job import job

from contactlab.experiments.roll_off import roll_off_effect

with job(snakemake) as log:
    given = snakemake.params
    write(roll_off_effect(**given.arguments), snakemake.output[0], log)
