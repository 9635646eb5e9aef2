"""Inputs hashed once in a run, where Snakemake hashes them again for each output of their job.

A specimen has over a hundred files of figures: eleven gigabytes a study, a twentieth of its time.
"""

import os

from snakemake.io import _IOFile


def hash_once():
    """Let Snakemake keep the checksum of a file until the file is changed or replaced."""
    hashed, known = _IOFile.checksum, {}

    async def checksum(file, *args, **kwargs):
        if not os.path.exists(file.file):  # the answer of Snakemake itself, which waits for it
            return await hashed(file, *args, **kwargs)
        state = os.stat(file.file)
        # The time that nobody sets: one put there with an older file's time is another.
        version = (file.file, state.st_ino, state.st_ctime_ns, args, *kwargs.items())
        if version not in known:
            known[version] = await hashed(file, *args, **kwargs)
        return known[version]

    _IOFile.checksum = checksum
