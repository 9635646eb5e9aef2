"""Write the result page of a study from its atlas and its figures."""

from pathlib import Path

from _job import job

from fractalcontact.pages.result_page import Place, write_result_page

with job(snakemake) as log:
    names = write_result_page(Place.of(Path(snakemake.input[0]).parent))
    log.info("%d specimens", len(names))
