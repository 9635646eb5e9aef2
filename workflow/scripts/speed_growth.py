"""How time and memory grow with the size of the grid, from the scenes measured."""

from _job import job

from fractalcontact import store
from fractalcontact.speed_growth import growth

with job(snakemake) as log:
    scenes = [store.read(path) for path in snakemake.input]
    result = growth(scenes, snakemake.params.error)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
