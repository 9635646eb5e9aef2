"""Put what was made of one specimen into an atlas of its own, and draw its figures from that."""

from pathlib import Path

from _job import reported
from _stages import read_stages, write_atlas

from fractalcontact.figures import draw_figures

with reported(snakemake.log) as log:
    stages = read_stages(snakemake.input)
    write_atlas(stages, snakemake.output.atlas, snakemake.params.configuration)
    captions = draw_figures(
        snakemake.output.atlas,
        snakemake.wildcards.specimen,
        Path(snakemake.output[0]).parent,
        snakemake.params.names,
    )
    for name, caption in captions.items():
        log.info("%s: %s", name, caption)
