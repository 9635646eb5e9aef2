"""Dimension and clusters of a measured contact map."""

from _job import job, require_unchanged

from fractalcontact.core import netcdf
from fractalcontact.domain.measured_map import read_contact_map

with job(snakemake) as log:
    params = snakemake.params
    result = read_contact_map(snakemake.input.scan, params.options, label=params.label)
    require_unchanged(params.digests)
    netcdf.write(result, snakemake.output[0])
    log.info("%s", result)
    if result.attrs["warning"]:
        log.warning("warning: %s", result.attrs["warning"])
