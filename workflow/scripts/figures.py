"""Put what was made of one specimen into an atlas of its own, and draw its figures from that."""

from pathlib import Path

from _drawn import report
from _job import job
from _stages import join_stages, read_stages

from fractalcontact.figures.draw import draw_figures

with job(snakemake) as log:
    stages, made_with = read_stages(snakemake.input)
    atlas = snakemake.output.atlas
    join_stages(stages, made_with, atlas, snakemake.params.configuration, log)
    specimen = snakemake.wildcards.specimen
    drawn = draw_figures(atlas, specimen, Path(snakemake.output[0]).parent, snakemake.params.names)
    report(drawn, specimen, snakemake.output.undrawn, log)
