"""Box counts and clusters of every contact domain; Delta_sigma from A_r(s) beside the boxes'."""

from _job import reported

from fractalcontact import store
from fractalcontact.analysis import analyse_domains, scaling_over_resolutions
from fractalcontact.specimen import cell_side
from fractalcontact.states import combine, domains_of

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    states = combine([store.read(path) for path in snakemake.input.contact])
    fields = domains_of(states)
    settings, spacing = snakemake.params.settings, cell_side(specimen)
    domains = analyse_domains(fields, spacing, fit_range=settings["box_range"])
    scaling = scaling_over_resolutions(
        store.read(snakemake.input.closure), domains, spacing, fit_range=settings["scaling_range"]
    )
    store.write(domains, snakemake.output.domains)
    store.write(fields, snakemake.output.contact)
    store.write(scaling, snakemake.output.scaling)
    log.info("%s\n%s", domains, scaling)
