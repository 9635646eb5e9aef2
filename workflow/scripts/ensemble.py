"""Contact of an ensemble: realisations of an embedded surface, or twins of a scan."""

from _files import read_inputs, write
from engine.job import job

from fractalcontact.core.settings import EnsembleSettings, Solver, read
from fractalcontact.ensemble.realisations import ensemble

with job(snakemake) as log:
    given = snakemake.params
    members = ensemble(
        **read_inputs(snakemake.input),
        recipe=given.recipe,
        realisations=given.realisations,
        settings=read(EnsembleSettings, given.settings),
        solver=Solver(**given.solver),
    )
    write(members, snakemake.output[0], log)
