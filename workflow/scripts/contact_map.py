"""Dimension and clusters of a measured contact map."""

import yaml
from _job import reported

from fractalcontact import store
from fractalcontact.contact_map import read_contact_map
from fractalcontact.study import read_sidecar

with reported(snakemake.log) as log:
    files = snakemake.input
    with open(files.schema, encoding="utf-8") as schema:
        options, settings = read_sidecar(files.sidecar, yaml.safe_load(schema))
    label = settings.get("label", snakemake.wildcards.map)
    result = read_contact_map(files.scan, options, label=label)
    store.write(result, snakemake.output[0])
    log.info("%s", result)
