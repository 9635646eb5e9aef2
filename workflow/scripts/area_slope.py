"""Real contact area at light load on synthetic surfaces, with and without a roll-off."""

from _job import job

from fractalcontact.core import netcdf
from fractalcontact.experiments.area_slope import area_slope

with job(snakemake) as log:
    slopes = area_slope(snakemake.params.recipe, snakemake.params.rtol)
    netcdf.write(slopes, snakemake.output[0])
    log.info("%s", slopes)
