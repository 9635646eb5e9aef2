"""What is known of a specimen before it is pressed: dimension, quality of the scan, joint."""

from _job import reported

from fractalcontact import store
from fractalcontact.joint import describe_joint
from fractalcontact.quality import scan_quality
from fractalcontact.quality_words import noise_words, range_words
from fractalcontact.roughness import surface_dimension

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input[0])
    settings = snakemake.params.settings
    joint = describe_joint(specimen, settings)
    dimension = surface_dimension(
        specimen.lower.values,
        (specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]),
        fit_range=settings["surface_range"],
    )
    quality = scan_quality(specimen, settings["resolutions"])
    store.write(joint, snakemake.output.joint)
    store.write(dimension, snakemake.output.surface_dimension)
    store.write(quality, snakemake.output.quality)
    log.info("%s\n%s", joint, dimension)
    for face in quality["face"].values:
        log.info("%s face: %s. %s", face, noise_words(quality, face), range_words(quality, face))
    if quality.attrs["warning"]:
        log.warning("warning: %s", quality.attrs["warning"])
