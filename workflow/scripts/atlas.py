"""Put what was made of all specimens into one file."""

from _job import reported
from _stages import read_stages, write_atlas

with reported(snakemake.log) as log:
    stages = read_stages(snakemake.input)
    write_atlas(stages, snakemake.output[0], snakemake.params.configuration)
    log.info("%d stages, specimens %s", len(stages), ", ".join(stages.get("specimens", {})))
