"""Read the scan of a specimen, level it, place its window, and say what is known of its joint."""

import yaml
from _job import reported

from fractalcontact import store
from fractalcontact.joint import describe_joint
from fractalcontact.preparation import prepare_specimen
from fractalcontact.quality import scan_quality
from fractalcontact.quality_words import noise_words, range_words
from fractalcontact.roughness import surface_dimension
from fractalcontact.study import read_sidecar

with reported(snakemake.log) as log:
    files, settings = snakemake.input, snakemake.params.settings
    with open(files.schema, encoding="utf-8") as schema:
        options, _ = read_sidecar(files.get("sidecar"), yaml.safe_load(schema))
    specimen = prepare_specimen(
        files.lower, files.get("upper"), options, settings, snakemake.wildcards.specimen
    )
    quality = scan_quality(specimen, settings["resolutions"])
    made = {
        "specimen": specimen,
        "joint": describe_joint(specimen, settings),
        "surface_dimension": surface_dimension(
            specimen.lower.values,
            (specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]),
            fit_range=settings["surface_range"],
        ),
        "quality": quality,
    }
    for name, dataset in made.items():
        store.write(dataset, snakemake.output[name])
    for key, value in specimen.attrs.items():
        log.info("%s: %s", key, value)
    log.info("%s\n%s", made["joint"], made["surface_dimension"])
    for face in quality["face"].values:
        log.info("%s face: %s. %s", face, noise_words(quality, face), range_words(quality, face))
    if quality.attrs["warning"]:
        log.warning("warning: %s", quality.attrs["warning"])
