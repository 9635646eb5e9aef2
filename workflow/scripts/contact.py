"""Solve the contact of one specimen and direction at some offsets and resolutions."""

from _job import reported

from fractalcontact import store
from fractalcontact.sweep import contact_states, map_place

with reported(snakemake.log) as log:
    params = snakemake.params
    direction = snakemake.wildcards.direction
    joint = store.read(snakemake.input.joint)
    cells = joint.offset_cells.sel(contact_direction=direction).values[slice(*params.offsets)]
    states = contact_states(
        store.read(snakemake.input.specimen),
        direction,
        cells,
        params.settings,
        params.resolutions,
        params.solver,
        mapped=map_place(joint, params.settings, direction)[1],
    )
    store.write(states, snakemake.output[0])
    log.info("%d states, largest residual %s", states.solved.sum(), states.residual.max().item())
