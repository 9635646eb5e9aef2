"""Figures of one specimen, from an atlas of its own made just before."""

import gc

from _figures import say_drawn
from _files import read_stages, warn_of_versions
from engine.job import job

from fractalcontact.core import netcdf
from fractalcontact.stages.atlas import join_stages, row_of

# Collecting the garbage of figures takes half a second of eleven, and the job ends after them.
gc.disable()

with job(snakemake) as log:
    output, given, specimen = snakemake.output, snakemake.params, snakemake.wildcards.specimen
    stages, made_with = read_stages(snakemake.input)
    warn_of_versions(join_stages(stages, output.atlas, given.configuration, made_with), log)
    if output.get("row"):
        netcdf.write(row_of(output.atlas, specimen), output.row)
    drawn = None
    if given.names:  # else nothing needs the figures and what they import
        from fractalcontact.figures.draw import draw_figures

        folder = f"results/{snakemake.config['study']}/figures/{specimen}"
        drawn = draw_figures(output.atlas, specimen, folder, given.names)
    say_drawn(drawn, output.undrawn, f"{specimen}/", log)
