"""Read the scan of a specimen, level it and place its window."""

import yaml
from _job import reported

from fractalcontact import store
from fractalcontact.scan import read_faces
from fractalcontact.specimen import make_specimen
from fractalcontact.study import read_sidecar, window_arguments

with reported(snakemake.log) as log:
    files = snakemake.input
    with open(files.schema, encoding="utf-8") as schema:
        options, _ = read_sidecar(files.get("sidecar"), yaml.safe_load(schema))
    lower, upper = read_faces(files.lower, files.get("upper"), options)
    settings = snakemake.params.settings
    name = snakemake.wildcards.specimen
    specimen = make_specimen(lower, upper, name=name, **window_arguments(settings))
    specimen.attrs["label"] = settings["label"]
    store.write(specimen, snakemake.output[0])
    for key, value in specimen.attrs.items():
        log.info("%s: %s", key, value)
