"""Read the scan of a specimen, level it and place its window."""

import yaml
from _job import reported

from fractalcontact import store
from fractalcontact.preparation import prepare_specimen
from fractalcontact.study import read_sidecar

with reported(snakemake.log) as log:
    files = snakemake.input
    with open(files.schema, encoding="utf-8") as schema:
        options, _ = read_sidecar(files.get("sidecar"), yaml.safe_load(schema))
    specimen = prepare_specimen(
        files.lower,
        files.get("upper"),
        options,
        snakemake.params.settings,
        snakemake.wildcards.specimen,
    )
    store.write(specimen, snakemake.output[0])
    for key, value in specimen.attrs.items():
        log.info("%s: %s", key, value)
