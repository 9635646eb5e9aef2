"""Levelled faces of a specimen, their roughness, and composite topographies at all its offsets."""

from _files import require_unchanged, write_outputs
from engine.job import job

from fractalcontact.core.settings import SpecimenSettings, read
from fractalcontact.stages.specimen import stages_of_scan

with job(snakemake) as log:
    given = snakemake.params
    stages = stages_of_scan(
        list(snakemake.input),
        given.options,
        read(SpecimenSettings, given.settings),
        snakemake.wildcards.specimen,
    )
    require_unchanged(given.digests)
    write_outputs(stages, snakemake.output, log)
