"""Put what was made of some specimens into one file."""

from pathlib import Path

from _job import reported

from fractalcontact import store

with reported(snakemake.log) as log:
    parts = {}
    for stage, paths in snakemake.input.items():
        paths = [paths] if isinstance(paths, str) else paths
        # Every stage keeps a specimen in a file of its name.
        parts[stage] = {Path(path).stem: store.read(path) for path in paths}
    configuration = snakemake.params.configuration
    study = configuration["study"]["study"]
    store.write_atlas(parts, snakemake.output[0], study=study, configuration=configuration)
    log.info("%d stages, specimens %s", len(parts), ", ".join(parts.get("specimens", {})))
