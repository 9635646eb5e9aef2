"""Contact states of sub-windows, and eq. 6 tested on them."""

from _files import read_inputs, write_outputs
from engine.job import job

from fractalcontact.core.settings import Solver, WindowSettings, read
from fractalcontact.stages.windows import window_stages

with job(snakemake) as log:
    given = snakemake.params
    stages = window_stages(
        **read_inputs(snakemake.input),
        settings=read(WindowSettings, given.settings),
        solver=Solver(**given.solver),
    )
    write_outputs(stages, snakemake.output, log)
