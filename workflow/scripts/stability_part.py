"""Judge every solver on some kinds of hard problems."""

from _job import job

from contactlab.accuracy.stability import stability
from fractalcontact.core import netcdf

with job(snakemake) as log:
    result = stability(snakemake.params.kinds, snakemake.params.draws)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
