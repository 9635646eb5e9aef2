"""Closure, dilatancy, box counts and renormalisation of contact states, and their errors."""

from _files import read_inputs, write_outputs
from engine.job import job

from fractalcontact.core.settings import Solver, StateSettings, read
from fractalcontact.stages.closure_and_box_counts import state_stages

with job(snakemake) as log:
    given = snakemake.params
    stages = state_stages(
        **read_inputs(snakemake.input),
        settings=read(StateSettings, given.settings),
        solver=Solver(**given.solver),
    )
    write_outputs(stages, snakemake.output, log)
