"""Put what was made of some specimens into one file."""

from _job import reported

from fractalcontact import store

with reported(snakemake.log) as log:
    parts = {}
    for stage in store.STAGES:
        paths = snakemake.input[stage]
        paths = [paths] if isinstance(paths, str) else paths
        names = snakemake.params.specimens
        parts[stage] = {n: store.read(path) for n, path in zip(names, paths, strict=True)}
    configuration = snakemake.params.configuration
    study = configuration["study"]["study"]
    store.write_atlas(parts, snakemake.output[0], study=study, configuration=configuration)
    log.info("%d stages, specimens %s", len(parts), ", ".join(snakemake.params.specimens))
