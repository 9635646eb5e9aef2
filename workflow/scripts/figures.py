"""Draw the figures of one specimen from its atlas."""

from _job import reported

from fractalcontact.figures import draw_figures

with reported(snakemake.log) as log:
    params = snakemake.params
    captions = draw_figures(
        snakemake.input[0], snakemake.wildcards.specimen, params.folder, params.names
    )
    for name, caption in captions.items():
        log.info("%s: %s", name, caption)
