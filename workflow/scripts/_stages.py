"""Stages of a study read from their files, for an atlas of them."""

from pathlib import Path

from fractalcontact.core import netcdf


def read_stages(files):
    """Datasets by stage and specimen, and the versions each was made with, from a job's input."""
    stages, made_with = {}, {}
    for stage, paths in files.items():
        # Every stage keeps a specimen in a file of its name.
        stages[stage], made_with[stage] = read_by_name(paths)
    return stages, made_with


def read_by_name(paths):
    """Datasets by the names of their files, and the versions each was made with."""
    paths = [paths] if isinstance(paths, str) else paths
    read = {Path(path).stem: netcdf.read_with_versions(path) for path in paths}
    return tuple({name: both[k] for name, both in read.items()} for k in (0, 1))


def warn_of_versions(differing, log):
    """Warn of parts that were made with other versions of libraries."""
    for versions, parts in differing.items():
        log.warning("warning: made with %s: %s", versions, ", ".join(parts))
