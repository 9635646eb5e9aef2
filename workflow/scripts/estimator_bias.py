"""How far the estimators of Delta_g are off, on made surfaces."""

from _job import reported

from fractalcontact import store
from fractalcontact.estimator_bias import estimator_bias

with reported(snakemake.log) as log:
    result = estimator_bias(snakemake.params.recipe)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
