"""Inputs hashed once in a run, where Snakemake hashes them again for each output of their job.

A specimen has over a hundred files of figures: eleven gigabytes a study, a twentieth of its time.
"""

from snakemake.io import _IOFile


def hash_once(digests):
    """Let Snakemake have the SHA-256 of files from ``digests``, a `core.checksums.Digests`."""
    hashed = _IOFile.checksum

    async def checksum(file, threshold=None, force=False, algorithm=None):
        usual = not (force or algorithm or file.is_storage)
        if usual and await file.is_checksum_eligible(threshold):
            return f"sha256:{digests.of(file.file)}"
        return await hashed(file, threshold, force, algorithm)

    _IOFile.checksum = checksum
