"""Contact states of a specimen in some directions, at some of its offsets and resolutions."""

from _files import read_inputs, write
from engine.job import job

from fractalcontact.core.settings import ContactSettings, Solver, read
from fractalcontact.states.sweep import joint_states

with job(snakemake) as log:
    given = snakemake.params
    states = joint_states(
        **read_inputs(snakemake.input),
        directions=given.directions,
        offsets=given.offsets,
        resolutions=given.resolutions,
        settings=read(ContactSettings, given.settings),
        solver=Solver(**given.solver),
    )
    write(states, snakemake.output[0], log)
