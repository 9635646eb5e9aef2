"""Figures over all specimens of a study, from its atlas."""

from pathlib import Path

from _figures import say_drawn
from engine.job import job

from fractalcontact.figures.draw import draw_study_figures

with job(snakemake) as log:
    atlas, given = snakemake.input[0], snakemake.params
    folder = Path(atlas).parent / "figures"
    drawn = draw_study_figures(atlas, given.specimens, folder, given.names)
    say_drawn(drawn, snakemake.output.undrawn, "", log)
