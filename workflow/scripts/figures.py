"""Draw the figures of one specimen from its atlas."""

from pathlib import Path

from _job import reported

from fractalcontact.figures import draw_figures

with reported(snakemake.log) as log:
    captions = draw_figures(
        snakemake.input[0],
        snakemake.wildcards.specimen,
        Path(snakemake.output[0]).parent,
        snakemake.params.names,
    )
    for name, caption in captions.items():
        log.info("%s: %s", name, caption)
