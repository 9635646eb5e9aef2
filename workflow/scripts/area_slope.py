"""Real contact area at light load, on surfaces with and without a roll-off."""

from _files import write
from engine.job import job

from contactlab.experiments.area_slope import area_slope

with job(snakemake) as log:
    given = snakemake.params
    write(area_slope(given.recipe, given.rtol), snakemake.output[0], log)
