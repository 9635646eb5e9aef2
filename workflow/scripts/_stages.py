"""Stages of a study read from their files, and written into one atlas."""

from pathlib import Path

from fractalcontact.core import netcdf
from fractalcontact.stages import atlas


def read_stages(files):
    """Datasets by stage and specimen, and the versions each was made with, from a job's input."""
    stages, made_with = {}, {}
    for stage, paths in files.items():
        paths = [paths] if isinstance(paths, str) else paths
        # Every stage keeps a specimen in a file of its name.
        read = {Path(path).stem: netcdf.read_with_versions(path) for path in paths}
        stages[stage] = {name: dataset for name, (dataset, _) in read.items()}
        made_with[stage] = {name: versions for name, (_, versions) in read.items()}
    return stages, made_with


def join_stages(stages, made_with, path, configuration, log):
    """Write one atlas of them, and warn of parts that were made with other versions."""
    differing = atlas.join_stages(stages, path, configuration, made_with)
    for versions, parts in differing.items():
        log.warning("warning: made with %s: %s", versions, ", ".join(parts))


def write_row(path, specimen, row_path):
    """Keep what of a specimen is compared with others in a file of its own."""
    netcdf.write(atlas.row_of(path, specimen), row_path)


def join_rows(rows, stages, made_with, path, configuration, log):
    """Write what specimens have together, and warn as :func:`join_stages` does."""
    read = {Path(row).stem: netcdf.read_with_versions(row) for row in rows}
    differing = atlas.join_rows(read, stages, path, configuration, made_with)
    for versions, names in differing.items():
        log.warning("warning: made with %s: %s", versions, ", ".join(names))
