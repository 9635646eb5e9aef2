"""Both estimates of Delta_sigma on made surfaces, over sizes and loads."""

from _job import reported

from fractalcontact import store
from fractalcontact.dimension_test import dimension_test

with reported(snakemake.log) as log:
    result = dimension_test(snakemake.params.recipe, snakemake.params.rtol)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
