"""Draw the figures of the whole study from its atlas."""

from pathlib import Path

from _job import job

from fractalcontact.figures.draw import draw_study_figures

with job(snakemake) as log:
    captions = draw_study_figures(
        snakemake.input[0],
        snakemake.params.specimens,
        Path(snakemake.output[0]).parent,
        snakemake.params.names,
    )
    for name, caption in captions.items():
        log.info("%s: %s", name, caption)
