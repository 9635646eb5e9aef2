"""What the scripts share that put stages of a study together."""

from pathlib import Path

from fractalcontact import store


def read_stages(files):
    """Datasets by stage and specimen, from the files of a job's input."""
    stages = {}
    for stage, paths in files.items():
        paths = [paths] if isinstance(paths, str) else paths
        # Every stage keeps a specimen in a file of its name.
        stages[stage] = {Path(path).stem: store.read(path) for path in paths}
    return stages


def write_atlas(stages, path, configuration):
    """One file of all of them, with the configuration that they were made by."""
    study = configuration["study"]["study"]
    store.write_atlas(stages, path, study=study, configuration=configuration)
