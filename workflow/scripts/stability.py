"""Put the verdicts on all kinds of hard scenes together."""

from _job import job

from fractalcontact import store
from fractalcontact.stability import join

with job(snakemake) as log:
    result = join([store.read(path) for path in snakemake.input])
    store.write(result, snakemake.output[0])
    log.info("%s", result)
