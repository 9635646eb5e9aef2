"""Aperture and transmissivity of a joint under its loads."""

from _files import read_inputs, write_outputs
from engine.job import job

from fractalcontact.core.settings import JointSettings, Solver, read
from fractalcontact.stages.flow import flow_stages

with job(snakemake) as log:
    given = snakemake.params
    stages = flow_stages(
        **read_inputs(snakemake.input),
        settings=read(JointSettings, given.settings),
        solver=Solver(**given.solver),
    )
    write_outputs(stages, snakemake.output, log)
