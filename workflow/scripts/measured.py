"""Laboratory tests beside computed curves."""

from _files import read_inputs, require_unchanged, write_outputs
from engine.job import job

from fractalcontact.core.settings import MeasuredSettings, Solver, read
from fractalcontact.measured.stage import measured_stage

with job(snakemake) as log:
    given = snakemake.params
    stages = measured_stage(
        **read_inputs(snakemake.input),
        settings=read(MeasuredSettings, given.settings),
        solver=Solver(**given.solver),
    )
    require_unchanged(given.digests)
    write_outputs(stages, snakemake.output, log)
