"""Write the page on every contact state of the study."""

from pathlib import Path

from _job import job

from fractalcontact.pages.explorer import write_explorer

with job(snakemake) as log:
    write_explorer(snakemake.input[0], snakemake.output[0])
    log.info("%.1f MB", Path(snakemake.output[0]).stat().st_size / 1e6)
