"""Put what was made of one specimen into an atlas of its own, and draw its figures from that."""

from _drawn import report
from _job import job
from _stages import join_stages, read_stages, write_row

with job(snakemake) as log:
    stages, made_with = read_stages(snakemake.input)
    atlas = snakemake.output.atlas
    join_stages(stages, made_with, atlas, snakemake.params.configuration, log)
    specimen = snakemake.wildcards.specimen
    if snakemake.output.get("row"):
        write_row(atlas, specimen, snakemake.output.row)
    names, drawn = snakemake.params.names, None
    if names:  # else nothing needs the figures and what they import
        from fractalcontact.figures.draw import draw_figures

        drawn = draw_figures(atlas, specimen, snakemake.params.folder, names)
    report(drawn, specimen, snakemake.output.undrawn, log)
