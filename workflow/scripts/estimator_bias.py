"""How far the estimators of Delta_g are off, on made surfaces."""

from _job import job

from fractalcontact import store
from fractalcontact.estimator_bias import estimator_bias

with job(snakemake) as log:
    result = estimator_bias(snakemake.params.recipe)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
