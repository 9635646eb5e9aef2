"""What the scripts share that put stages of a study together."""

from pathlib import Path

from fractalcontact import store
from fractalcontact.statements import judge


def read_stages(files):
    """Datasets by stage and specimen, from the files of a job's input."""
    stages = {}
    for stage, paths in files.items():
        paths = [paths] if isinstance(paths, str) else paths
        # Every stage keeps a specimen in a file of its name.
        stages[stage] = {Path(path).stem: store.read(path) for path in paths}
    return stages


def write_atlas(stages, path, configuration):
    """One file of all of them, with the configuration that they were made by.

    And with the paper's statements, judged for every specimen of the configuration.
    """
    judged = {}
    for name, settings in configuration["settings"].items():
        # Contact maps, the study's, stand under names of their own.
        of_joint = {stage: parts[name] for stage, parts in stages.items() if name in parts}
        judged[name] = judge(of_joint, settings)
    everything = stages | ({"statements": judged} if judged else {})
    study = configuration["study"]["study"]
    store.write_atlas(everything, path, study=study, configuration=configuration)
