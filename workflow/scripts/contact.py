"""Solve the contact of one specimen in some directions, at some offsets and resolutions."""

from _job import job

from fractalcontact.core import netcdf, settings
from fractalcontact.mechanics.sweep import joint_states

with job(snakemake) as log:
    params = snakemake.params
    states = joint_states(
        netcdf.read(snakemake.input.specimens),
        netcdf.read(snakemake.input.joints),
        params.directions,
        slice(*params.offsets),
        resolutions=params.resolutions,
        **settings.arguments(joint_states, params.settings),
    )
    netcdf.write(states, snakemake.output[0])
    log.info("%d states, largest residual %s", states.solved.sum(), states.residual.max().item())
