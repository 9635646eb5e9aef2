"""Say why a scan is left out of the study."""

from _job import job

from fractalcontact.core.errors import InputError

with job(snakemake):
    raise InputError(snakemake.params.reason)
