"""Make an embedded specimen: a scan file like any other, with its sidecar."""

from pathlib import Path

from engine.job import job

from fractalcontact.study.embedded import write_scan
from fractalcontact.surface.embedded import embedded_surface

with job(snakemake) as log:
    recipe = snakemake.params.recipe
    heights = embedded_surface(recipe)
    write_scan(Path(snakemake.output.scan), heights, recipe["spacing"], sidecar={})
    log.info("%s nodes, %s", heights.shape, recipe)
