"""Judge every solver on some kinds of hard scenes."""

from _job import job

from fractalcontact import store
from fractalcontact.stability import stability

with job(snakemake) as log:
    result = stability(snakemake.params.kinds, snakemake.params.draws)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
