"""Both estimates of Delta_sigma on synthetic surfaces, over sizes and loads."""

from _job import job

from fractalcontact.core import netcdf
from fractalcontact.experiments.delta_sigma import dimension_test

with job(snakemake) as log:
    result = dimension_test(snakemake.params.recipe, snakemake.params.rtol)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
