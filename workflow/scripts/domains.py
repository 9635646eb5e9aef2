"""What is made of the contact domains: box counts, clusters, Delta_sigma, measures over loads."""

from _job import reported

from fractalcontact import store
from fractalcontact.analysis import analyse_domains, scaling_over_resolutions
from fractalcontact.domain_measures import measures_of_map_states
from fractalcontact.specimen import cell_side
from fractalcontact.states import combine, domains_of, map_states

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    parts = [store.read(path) for path in snakemake.input.contact]
    fields = domains_of(combine(parts))
    settings, spacing = snakemake.params.settings, cell_side(specimen)
    domains = analyse_domains(fields, spacing, fit_range=settings["box_range"])
    scaling = scaling_over_resolutions(
        store.read(snakemake.input.closure), domains, spacing, fit_range=settings["scaling_range"]
    )
    measures = measures_of_map_states(map_states(parts), spacing)
    store.write(domains, snakemake.output.domains)
    store.write(fields, snakemake.output.contact)
    store.write(scaling, snakemake.output.scaling)
    store.write(measures, snakemake.output.domain_measures)
    log.info("%s\n%s\n%s", domains, scaling, measures)
