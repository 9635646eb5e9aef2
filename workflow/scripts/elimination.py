"""Try whether dropping points alone reaches the right contact set."""

from _job import job

from fractalcontact import store
from fractalcontact.elimination import elimination

with job(snakemake) as log:
    result = elimination(snakemake.params.draws)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
