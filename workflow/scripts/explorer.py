"""Explorer of all contact states, in one page, from the atlas."""

from pathlib import Path

from engine.job import job

from fractalcontact.pages.explorer import write_explorer

with job(snakemake) as log:
    atlas, page = Path(snakemake.input[0]), Path(snakemake.output[0])
    write_explorer(atlas, page, snakemake.params.explored)
    log.info("%.1f MB", page.stat().st_size / 1e6)
