"""Read the scan of a specimen, level it, place its window, and describe its joint."""

import json

from _job import job, require_unchanged

from fractalcontact.core import netcdf
from fractalcontact.core.errors import InputError
from fractalcontact.core.settings import SpecimenSettings, read
from fractalcontact.roughness.quality_words import noise_words, range_words
from fractalcontact.stages.specimen import specimen_stages
from fractalcontact.study.preparation import prepare_specimen

with job(snakemake) as log:
    files, params, name = snakemake.input, snakemake.params, snakemake.wildcards.specimen
    upper = files.get("upper")
    settings = read(SpecimenSettings, params.settings["settings"])
    specimen = prepare_specimen(files.lower, upper, params.options, settings, name)
    stages = specimen_stages(specimen, settings)
    # What was read, and what lies there now: a file may have been exchanged and put back.
    require_unchanged(params.digests)
    for face, digest in zip(("lower", "upper"), params.digests.values(), strict=False):
        if json.loads(specimen.attrs[f"{face}_scan"])["sha256"] != digest:
            raise InputError(f"{files[face]}: changed while it was read; run the study again")
    for stage, dataset in stages.items():
        netcdf.write(dataset, snakemake.output[stage])
    for key, value in specimen.attrs.items():
        log.info("%s: %s", key, value)
    log.info("%s\n%s", stages["joints"], stages["surface_dimension"])
    quality = stages["quality"]
    for face in quality["face"].values:
        log.info("%s face: %s. %s", face, noise_words(quality, face), range_words(quality, face))
    if quality.attrs["warning"]:
        log.warning("warning: %s", quality.attrs["warning"])
