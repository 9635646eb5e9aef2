"""Write all stages of all specimens into one file, the atlas."""

from _job import job
from _stages import join_stages, read_stages

from fractalcontact.core.atomic import atomic_write

with job(snakemake) as log:
    stages, made_with = read_stages(snakemake.input)
    join_stages(stages, made_with, snakemake.output[0], snakemake.params.configuration, log)
    if snakemake.output.get("names"):
        names = sorted([*stages.get("specimens", {}), *stages.get("contact_maps", {})])
        with atomic_write(snakemake.output.names) as path:
            path.write_text("".join(f"{name}\n" for name in names), encoding="utf-8")
    log.info("%d stages, specimens %s", len(stages), ", ".join(stages.get("specimens", {})))
