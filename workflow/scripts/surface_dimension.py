"""Estimate the dimension of a specimen's face."""

from _job import reported

from fractalcontact import store
from fractalcontact.roughness import surface_dimension

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input[0])
    result = surface_dimension(
        specimen.lower.values,
        (specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]),
        fit_range=snakemake.params.settings["surface_range"],
    )
    store.write(result, snakemake.output[0])
    log.info("%s", result)
