"""Read the scan of a specimen, level it, place its window, and say what is known of its joint."""

import json

from _job import job, require_unchanged

from fractalcontact.core import netcdf
from fractalcontact.core.errors import InputError
from fractalcontact.mechanics.joint import describe_joint
from fractalcontact.roughness.dimension import surface_dimension
from fractalcontact.roughness.quality import scan_quality
from fractalcontact.roughness.quality_words import noise_words, range_words
from fractalcontact.study.preparation import prepare_specimen
from fractalcontact.surface.grid import spacing_of

with job(snakemake) as log:
    files, params, name = snakemake.input, snakemake.params, snakemake.wildcards.specimen
    settings = params.settings
    specimen = prepare_specimen(files.lower, files.get("upper"), params.options, settings, name)
    quality = scan_quality(specimen, settings["resolutions"])
    made = {
        "specimen": specimen,
        "joint": describe_joint(specimen, settings),
        "surface_dimension": surface_dimension(
            specimen.lower.values,
            spacing_of(specimen),
            fit_range=settings["surface_range"],
        ),
        "quality": quality,
    }
    # What was read, and what lies there now: a file may have been exchanged and put back.
    require_unchanged(params.digests)
    for face, digest in zip(("lower", "upper"), params.digests.values(), strict=False):
        if json.loads(specimen.attrs[f"{face}_scan"])["sha256"] != digest:
            raise InputError(f"{files[face]}: changed while it was read; run the study again")
    for stage, dataset in made.items():
        netcdf.write(dataset, snakemake.output[stage])
    for key, value in specimen.attrs.items():
        log.info("%s: %s", key, value)
    log.info("%s\n%s", made["joint"], made["surface_dimension"])
    for face in quality["face"].values:
        log.info("%s face: %s. %s", face, noise_words(quality, face), range_words(quality, face))
    if quality.attrs["warning"]:
        log.warning("warning: %s", quality.attrs["warning"])
