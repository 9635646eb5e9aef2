"""Bias of the estimators of Delta_g, on synthetic surfaces."""

from _job import job

from fractalcontact.core import netcdf
from fractalcontact.experiments.delta_g import estimator_bias

with job(snakemake) as log:
    result = estimator_bias(snakemake.params.recipe)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
