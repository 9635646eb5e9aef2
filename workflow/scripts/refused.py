"""Fail with what is wrong with a scan that the study leaves out."""

from engine.job import job

from fractalcontact.core.errors import InputError

with job(snakemake):
    raise InputError(snakemake.params.reason)
