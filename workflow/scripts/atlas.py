"""Write all stages of all specimens into one file; or what specimens have together, row by row."""

from pathlib import Path

from _job import job
from _stages import join_rows, join_stages, read_stages

from fractalcontact.core.atomic import atomic_write

with job(snakemake) as log:
    files = dict(snakemake.input.items())
    rows = files.pop("rows", [])
    rows = [rows] if isinstance(rows, str) else rows
    stages, made_with = read_stages(files)
    output, configuration = snakemake.output, snakemake.params.configuration
    if rows:
        join_rows(rows, stages, made_with, output[0], configuration, log)
    else:
        join_stages(stages, made_with, output[0], configuration, log)
    names = {*(Path(row).stem for row in rows), *stages.get("specimens", {})}
    if output.get("names"):
        listed = sorted({*names, *stages.get("contact_maps", {})})
        with atomic_write(output.names) as path:
            path.write_text("".join(f"{name}\n" for name in listed), encoding="utf-8")
    log.info("%d specimens", len(names))
