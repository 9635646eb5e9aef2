"""Index of the study, and tables beside it, from the atlas."""

from pathlib import Path

from engine.job import job

from fractalcontact.pages.result_page import Place, write_index

with job(snakemake) as log:
    results = Path(snakemake.input[0]).parent
    log.info("%d specimens", len(write_index(Place.of(results), snakemake.params.explored)))
