"""Measure how good the scan of a specimen is, and warn of resolutions below its noise floor."""

from _job import reported

from fractalcontact import store
from fractalcontact.quality import noise_words, range_words, scan_quality

with reported(snakemake.log) as log:
    quality = scan_quality(store.read(snakemake.input[0]), snakemake.params.resolutions)
    store.write(quality, snakemake.output[0])
    for face in quality["face"].values:
        log.info("%s face: %s. %s", face, noise_words(quality, face), range_words(quality, face))
    if quality.attrs["warning"]:
        log.warning("warning: %s", quality.attrs["warning"])
