"""Datasets that a script reads and writes, by the names of its rule's inputs and outputs."""

from pathlib import Path

# Scripts import this file first of all, and it imports numpy. This sets the threads of BLAS before.
import engine.job  # noqa: F401

from fractalcontact.core import checksums, netcdf
from fractalcontact.core.errors import InputError


def read_inputs(inputs):
    """Datasets by the names of a rule's inputs: of several files a list, of no file none."""
    return {
        name: netcdf.read(paths) if isinstance(paths, str) else [netcdf.read(p) for p in paths]
        for name, paths in inputs.items()
        if paths
    }


def write_outputs(stages, outputs, log):
    """Write the datasets of a rule's outputs, by name, and say what they hold and warn of."""
    for name, path in outputs.items():
        write(stages[name], path, log)


def write(dataset, path, log):
    """Write a dataset, and say what it holds and warns of."""
    netcdf.write(dataset, path)
    log.info("%s", dataset)
    if dataset.attrs.get("warning"):
        log.warning("warning: %s", dataset.attrs["warning"])


def require_unchanged(digests):
    """Refuse what was made of scan files whose digests are no longer those of the plan.

    The results would not belong to them, and nothing would show it.
    """
    for path, digest in digests.items():
        if digest and (not Path(path).is_file() or checksums.sha256(path) != digest):
            raise InputError(f"{path}: changed while the study ran; run it again")


def read_stages(paths):
    """Datasets by stage, the folder of a file, and by specimen, its name; and their versions."""
    stages, made_with = {}, {}
    for path in map(Path, paths):
        stage, name = path.parent.name, path.stem
        dataset, versions = netcdf.read_with_versions(path)
        stages.setdefault(stage, {})[name] = dataset
        made_with.setdefault(stage, {})[name] = versions
    return stages, made_with


def warn_of_versions(differing, log):
    """Warn of parts that were made with other versions of libraries."""
    for versions, parts in differing.items():
        log.warning("warning: made with %s: %s", versions, ", ".join(parts))
