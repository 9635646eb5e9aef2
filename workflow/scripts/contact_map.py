"""Measured map of contact, and its dimension."""

from _files import require_unchanged, write
from engine.job import job

from fractalcontact.domain.measured_map import read_contact_map

with job(snakemake) as log:
    given = snakemake.params
    domain = read_contact_map(snakemake.input[0], given.options, label=given.label)
    require_unchanged(given.digests)
    write(domain, snakemake.output[0], log)
