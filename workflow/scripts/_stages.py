"""What the scripts share that put stages of a study together."""

from pathlib import Path

from fractalcontact.core import netcdf
from fractalcontact.statements.judge import judge
from fractalcontact.study.atlas import write_atlas


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
    """One file of all of them, with the configuration and the versions that they were made by.

    And with the paper's statements, judged for every specimen of the configuration.
    """
    judged = {}
    # A label is only words: no job before this one has it, so that a new one solves nothing again.
    for name, dataset in stages.get("specimens", {}).items():
        dataset.attrs["label"] = configuration["settings"][name]["label"]
    for name, settings in configuration["settings"].items():
        # Contact maps, the study's, stand under names of their own.
        of_joint = {stage: parts[name] for stage, parts in stages.items() if name in parts}
        judged[name] = judge(of_joint, settings)
    everything = stages | ({"statements": judged} if judged else {})
    study = configuration["study"]["study"]
    differing = write_atlas(
        everything, path, study=study, configuration=configuration, made_with=made_with
    )
    for versions, parts in differing.items():
        log.warning("warning: made with %s: %s", versions, ", ".join(parts))
