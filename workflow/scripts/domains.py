"""Box counts, dimension and clusters of every contact domain."""

from _job import reported

from fractalcontact import store
from fractalcontact.analysis import analyse_domains
from fractalcontact.specimen import cell_side
from fractalcontact.states import combine, domains_of

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    states = combine([store.read(path) for path in snakemake.input.contact])
    fields = domains_of(states)
    domains = analyse_domains(
        fields, cell_side(specimen), fit_range=snakemake.params.settings["box_range"]
    )
    store.write(domains, snakemake.output.domains)
    store.write(fields, snakemake.output.contact)
    log.info("%s", domains)
