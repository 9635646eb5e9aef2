"""Put the verdicts on all kinds of hard problems together."""

from _job import job

from contactlab.accuracy.stability import join
from fractalcontact.core import netcdf

with job(snakemake) as log:
    result = join([netcdf.read(path) for path in snakemake.input])
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
