"""Estimators of Delta_g on surfaces of known dimension."""

from _files import write
from engine.job import job

from contactlab.experiments.delta_g import estimator_bias

with job(snakemake) as log:
    given = snakemake.params
    write(estimator_bias(given.recipe), snakemake.output[0], log)
