"""What changes with resolution: Delta_sigma from A_r(s), sigma*, beside the box counts."""

from _job import reported

from fractalcontact import store
from fractalcontact.analysis import scaling_over_resolutions
from fractalcontact.specimen import cell_side

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    scaling = scaling_over_resolutions(
        store.read(snakemake.input.closure),
        store.read(snakemake.input.domains),
        cell_side(specimen),
        fit_range=snakemake.params.settings["scaling_range"],
    )
    store.write(scaling, snakemake.output[0])
    log.info("%s", scaling)
