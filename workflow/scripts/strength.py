"""Strength, size laws and the paper's statements of a specimen: nothing is solved."""

from _files import read_inputs, write_outputs
from engine.job import job

from fractalcontact.core.settings import ReportSettings, read
from fractalcontact.stages.strength import strength_stages

with job(snakemake) as log:
    given = snakemake.params
    stages = strength_stages(
        **read_inputs(snakemake.input),
        settings=read(ReportSettings, given.settings),
    )
    write_outputs(stages, snakemake.output, log)
