"""Try whether dropping points alone reaches the right contact set."""

from _job import reported

from fractalcontact import store
from fractalcontact.elimination import elimination

with reported(snakemake.log) as log:
    result = elimination(snakemake.params.draws)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
