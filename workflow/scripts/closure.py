"""Closure curves with their hyperbolas, elastic dilatancy, laws of the real contact area."""

from _job import reported

from fractalcontact import store
from fractalcontact.area import area_laws, joint_statistics
from fractalcontact.closure import closure_curves, elastic_dilatancy
from fractalcontact.needs import choices
from fractalcontact.roughness import best_dimension
from fractalcontact.specimen import window_sides
from fractalcontact.states import combine, force_range

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    joint = store.read(snakemake.input.joint)
    settings = snakemake.params.settings
    curves = closure_curves(
        combine([store.read(path) for path in snakemake.input.contact]),
        window_sides(specimen),
        settings["material"]["e_star"],
        force_range(settings["hyperbola_range"], specimen),
    )
    dilatancy = elastic_dilatancy(curves, joint)
    store.write(curves, snakemake.output.closure)
    store.write(dilatancy, snakemake.output.dilatancy)
    made = choices(curves, dilatancy, settings, snakemake.params.solver)
    store.write(made, snakemake.output.choices)
    laws = area_laws(
        curves,
        joint_statistics(specimen, joint),
        settings["material"]["e_star"],
        best_dimension(store.read(snakemake.input.surface_dimension))[0],
    )
    store.write(laws, snakemake.output.area)
    log.info("%s\n%s\n%s", curves, dilatancy, laws)
