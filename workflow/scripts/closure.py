"""Closure curves with their hyperbolas, and elastic dilatancy."""

from _job import reported

from fractalcontact import store
from fractalcontact.closure import closure_curves, elastic_dilatancy
from fractalcontact.needs import choices
from fractalcontact.specimen import window_sides
from fractalcontact.states import combine, force_range

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    settings = snakemake.params.settings
    curves = closure_curves(
        combine([store.read(path) for path in snakemake.input.contact]),
        window_sides(specimen),
        settings["material"]["e_star"],
        force_range(settings["hyperbola_range"], specimen),
    )
    dilatancy = elastic_dilatancy(curves, store.read(snakemake.input.joint))
    store.write(curves, snakemake.output.closure)
    store.write(dilatancy, snakemake.output.dilatancy)
    store.write(choices(curves, settings, snakemake.params.solver), snakemake.output.choices)
    log.info("%s\n%s", curves, dilatancy)
