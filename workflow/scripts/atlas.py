"""Write all stages of all specimens into one file; or what the atlases of each have together."""

from pathlib import Path

from _job import job
from _stages import join_parts, join_stages, read_stages

from fractalcontact.core.atomic import atomic_write

with job(snakemake) as log:
    files = dict(snakemake.input.items())
    listed = files.pop("parts", [])
    listed = [listed] if isinstance(listed, str) else listed
    parts = {Path(path).stem: Path(path) for path in listed}
    stages, made_with = read_stages(files)
    output, configuration = snakemake.output, snakemake.params.configuration
    if parts:
        join_parts(parts, stages, made_with, output[0], configuration, log)
    else:
        join_stages(stages, made_with, output[0], configuration, log)
    if output.get("names"):
        specimens = [*parts, *stages.get("specimens", {}), *stages.get("contact_maps", {})]
        with atomic_write(output.names) as path:
            path.write_text("".join(f"{name}\n" for name in sorted(specimens)), encoding="utf-8")
    log.info("%d specimens", len({*parts, *stages.get("specimens", {})}))
