"""What is made of the contact states of a specimen: curves, laws of area, domains, dimensions."""

from _job import job

from fractalcontact.core import netcdf
from fractalcontact.domain.analysis import analyse_domains, scaling_over_resolutions
from fractalcontact.domain.measures import measures_of_map_states
from fractalcontact.mechanics.area import area_laws, joint_statistics
from fractalcontact.mechanics.closure import closure_curves, elastic_dilatancy
from fractalcontact.mechanics.plan import solve_plan
from fractalcontact.mechanics.states import combine, domains_of, force_range, map_states
from fractalcontact.mechanics.strength import joint_strength
from fractalcontact.roughness.dimension import best_dimension
from fractalcontact.surface.specimen import cell_side, window_sides

with job(snakemake) as log:
    specimen = netcdf.read(snakemake.input.specimen)
    joint = netcdf.read(snakemake.input.joint)
    parts = [netcdf.read(path) for path in snakemake.input.contact]
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
        best_dimension(netcdf.read(snakemake.input.surface_dimension))[0],
    )
    fields = domains_of(states)
    domains = analyse_domains(fields, spacing, fit_range=settings["box_range"])
    made = {
        "closure": curves,
        "dilatancy": dilatancy,
        "choices": solve_plan(curves, dilatancy, settings, snakemake.params.solver),
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
        netcdf.write(dataset, snakemake.output[stage])
        log.info("%s", dataset)
