"""What is made of the contact states of a specimen: curves, laws of area, domains, dimensions."""

from _job import job

from fractalcontact import store
from fractalcontact.analysis import analyse_domains, scaling_over_resolutions
from fractalcontact.area import area_laws, joint_statistics
from fractalcontact.closure import closure_curves, elastic_dilatancy
from fractalcontact.domain_measures import measures_of_map_states
from fractalcontact.needs import choices
from fractalcontact.roughness import best_dimension
from fractalcontact.specimen import cell_side, window_sides
from fractalcontact.states import combine, domains_of, force_range, map_states
from fractalcontact.strength import joint_strength

with job(snakemake) as log:
    specimen = store.read(snakemake.input.specimen)
    joint = store.read(snakemake.input.joint)
    parts = [store.read(path) for path in snakemake.input.contact]
    states, settings, spacing = combine(parts), snakemake.params.settings, cell_side(specimen)
    e_star = settings["material"]["e_star"]
    curves = closure_curves(
        states,
        window_sides(specimen),
        e_star,
        force_range(settings["hyperbola_range"], specimen),
    )
    dilatancy = elastic_dilatancy(curves, joint)
    laws = area_laws(
        curves,
        joint_statistics(specimen, joint),
        e_star,
        best_dimension(store.read(snakemake.input.surface_dimension))[0],
    )
    fields = domains_of(states)
    domains = analyse_domains(fields, spacing, fit_range=settings["box_range"])
    made = {
        "closure": curves,
        "dilatancy": dilatancy,
        "choices": choices(curves, dilatancy, settings, snakemake.params.solver),
        "area": laws,
        "domains": domains,
        "contact": fields,
        "scaling": scaling_over_resolutions(
            curves, domains, spacing, fit_range=settings["scaling_range"]
        ),
        "domain_measures": measures_of_map_states(map_states(parts), spacing),
    }
    if snakemake.output.get("strength"):
        made["strength"] = joint_strength(dilatancy, joint, specimen, settings)
    for stage, dataset in made.items():
        store.write(dataset, snakemake.output[stage])
        log.info("%s", dataset)
