"""All stages of all specimens in one file; or what specimens have together, row by row."""

from pathlib import Path

from _files import read_stages, warn_of_versions
from engine.job import job

from fractalcontact.core.atomic import atomic_write
from fractalcontact.stages.atlas import join_rows, join_stages

with job(snakemake) as log:
    files, configuration = snakemake.input, snakemake.params.configuration
    stages, made_with = read_stages([*files.stages, *files.maps, *files.laboratory])
    rows, versions = read_stages(files.rows)
    if rows:
        of_specimens = {name: (row, versions["rows"][name]) for name, row in rows["rows"].items()}
        joined = join_rows, of_specimens, stages
    else:
        joined = join_stages, stages
    join, *parts = joined
    warn_of_versions(join(*parts, snakemake.output[0], configuration, made_with), log)
    names = rows.get("rows", {}).keys() | stages.get("specimens", {}).keys()
    with atomic_write(snakemake.output.names) as path:
        listed = sorted(names | stages.get("contact_maps", {}).keys())
        Path(path).write_text("".join(f"{name}\n" for name in listed), encoding="utf-8")
    log.info("%d specimens", len(names))
