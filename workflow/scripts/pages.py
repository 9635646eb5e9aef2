"""Write the explorer of all contact states, or the index of the study, from the atlas."""

from pathlib import Path

from engine.job import job

from fractalcontact.pages.explorer import write_explorer
from fractalcontact.pages.result_page import Place, write_index

with job(snakemake) as log:
    atlas, page = Path(snakemake.input[0]), Path(snakemake.output[0])
    explored = snakemake.params.explored
    if snakemake.rule == "explorer":
        write_explorer(atlas, page, explored)
        log.info("%.1f MB", page.stat().st_size / 1e6)
    else:
        log.info("%d specimens", len(write_index(Place.of(atlas.parent), explored)))
