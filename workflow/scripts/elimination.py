"""Try whether dropping points alone reaches the right contact set."""

from _job import job

from contactlab.accuracy.elimination import elimination
from fractalcontact.core import netcdf

with job(snakemake) as log:
    result = elimination(snakemake.params.draws)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
