"""How time and memory grow with the size of the grid, from the scenes measured."""

from _job import job

from fractalcontact.accuracy.growth import growth
from fractalcontact.core import netcdf

with job(snakemake) as log:
    scenes = [netcdf.read(path) for path in snakemake.input]
    result = growth(scenes, snakemake.params.error)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
