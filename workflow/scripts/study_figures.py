"""Draw the figures of the whole study from its atlas."""

from pathlib import Path

from _drawn import report
from _job import job

from fractalcontact.figures.draw import draw_study_figures

with job(snakemake) as log:
    drawn = draw_study_figures(
        snakemake.input[0],
        snakemake.params.specimens,
        Path(snakemake.input[0]).parent / "figures",
        snakemake.params.names,
    )
    report(drawn, "", snakemake.output.undrawn, log)
