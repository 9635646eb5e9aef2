"""How time and memory grow with the size of the grid, from the problems measured."""

from _job import job

from contactlab.accuracy.growth import growth
from fractalcontact.core import netcdf

with job(snakemake) as log:
    problems = [netcdf.read(path) for path in snakemake.input]
    result = growth(problems, snakemake.params.error)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
