"""Lacunarity, correlation and generalised dimensions of the contact at the map offset."""

from _job import reported

from fractalcontact import store
from fractalcontact.domain_measures import measures_of_states
from fractalcontact.specimen import cell_side
from fractalcontact.sweep import map_states

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    settings = snakemake.params.settings
    joint = store.read(snakemake.input.joint)
    states = map_states(specimen, joint, settings, snakemake.params.solver)
    measures = measures_of_states(
        states["in_contact"].values,
        states["pressure"].values,
        cell_side(specimen),
        states["load"].values,
    ).assign_coords(direction=states["direction"], offset=states["offset"])
    store.write(measures, snakemake.output[0])
    log.info("%s", measures)
