"""Write all stages of all specimens into one file; or what specimens have together, row by row."""

from pathlib import Path

from _stages import read_by_name, read_stages, warn_of_versions
from engine.job import job

from fractalcontact.core.atomic import atomic_write
from fractalcontact.stages.atlas import join_rows, join_stages

with job(snakemake) as log:
    files = dict(snakemake.input.items())
    datasets, versions = read_by_name(files.pop("rows", []))
    rows = {name: (dataset, versions[name]) for name, dataset in datasets.items()}
    stages, made_with = read_stages(files)
    output, configuration = snakemake.output, snakemake.params.configuration
    if rows:
        differing = join_rows(rows, stages, output[0], configuration, made_with)
    else:
        differing = join_stages(stages, output[0], configuration, made_with)
    warn_of_versions(differing, log)
    names = {*rows, *stages.get("specimens", {})}
    if output.get("names"):
        listed = sorted({*names, *stages.get("contact_maps", {})})
        with atomic_write(output.names) as path:
            Path(path).write_text("".join(f"{name}\n" for name in listed), encoding="utf-8")
    log.info("%d specimens", len(names))
