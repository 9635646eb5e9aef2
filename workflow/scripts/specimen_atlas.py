"""Atlas of one specimen, and its row in the atlas of a campaign."""

from _files import read_stages, warn_of_versions
from engine.job import job

from fractalcontact.core import netcdf
from fractalcontact.stages.atlas import join_stages, row_of

with job(snakemake) as log:
    output, given = snakemake.output, snakemake.params
    stages, made_with = read_stages(snakemake.input)
    warn_of_versions(join_stages(stages, output.atlas, given.configuration, made_with), log)
    if output.get("row"):
        netcdf.write(row_of(output.atlas, snakemake.wildcards.specimen), output.row)
