"""Figures of one specimen, from its own atlas."""

import gc

from _figures import say_drawn
from engine.job import job

from fractalcontact.figures.draw import draw_figures

# Collecting the garbage of figures takes half a second of eleven, and the job ends after them.
gc.disable()

with job(snakemake) as log:
    given, specimen = snakemake.params, snakemake.wildcards.specimen
    folder = f"results/{snakemake.config['study']}/figures/{specimen}"
    drawn_from = snakemake.output.drawn_from
    drawn = draw_figures(snakemake.input[0], specimen, folder, given.names, drawn_from, given.code)
    say_drawn(drawn, snakemake.output.undrawn, f"{specimen}/", log)
