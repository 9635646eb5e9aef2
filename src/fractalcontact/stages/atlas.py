"""The atlas of a study from its stages, with the paper's statements judged."""

from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from ..statements.judge import judge
from ..statements.study import judge_study
from ..study.atlas import write_atlas

#: Name of the one group of what is judged for the study as a whole.
WHOLE = "study"


def join_stages(
    stages: Mapping[str, Mapping[str, xr.Dataset]],
    path: Path | str,
    configuration: Mapping,
    made_with: Mapping[str, Mapping[str, dict]] | None = None,
) -> dict[str, list[str]]:
    """Write stages into one atlas, and with them the statements, judged for every specimen.

    Parameters
    ----------
    stages : mapping of str to mapping of str to xr.Dataset
        Stage to specimen to dataset.
    path : path-like
    configuration : mapping
        ``study``, as its user wrote it, and ``settings``, from
        :func:`study.configuration.resolve_settings` by specimen.
    made_with : mapping of str to mapping of str to dict, optional
        As :func:`study.atlas.write_atlas` takes it.

    Returns
    -------
    dict of str to list of str
        As :func:`study.atlas.write_atlas` gives it.
    """
    # A label is only words: no job before this one has it, so that a new one solves nothing again.
    for name, dataset in stages.get("specimens", {}).items():
        dataset.attrs["label"] = configuration["settings"][name]["label"]
    # Measured contact maps, the study's, stand under names of their own.
    of_joints = {
        name: {stage: parts[name] for stage, parts in stages.items() if name in parts}
        for name in configuration["settings"]
    }
    everything = {**stages, **_judged(of_joints, configuration)}
    study = configuration["study"]["study"]
    return write_atlas(
        _without_remade_fields(everything),
        path,
        study=study,
        configuration=configuration,
        made_with=made_with,
    )


def _without_remade_fields(stages):
    """Stages without the composite topographies that no figure draws, the bulk of them.

    They are missing, but for the largest offset; the file of the stage has all.
    """
    joints = {
        name: joint.assign(
            composite=joint["composite"].where(joint["offset"] == joint["offset"].max())
        )
        for name, joint in stages.get("joints", {}).items()
    }
    return {**stages, "joints": joints} if joints else stages


def _judged(of_joints, configuration):
    """Statements of every specimen and, where there are several, of the study."""
    if not of_joints:
        return {}
    settings = configuration["settings"]
    variants = {name for name in of_joints if settings[name]["capped_variant"]}
    judged = {
        name: judge(
            stages,
            settings[name],
            circular=settings[name]["chosen_for"],
            capped_variant=name in variants,
        )
        for name, stages in of_joints.items()
    }
    own = {name: stages for name, stages in of_joints.items() if name not in variants}
    # The atlas of one specimen, which its figures are drawn from, has no study to judge.
    several = {"study_statements": {WHOLE: judge_study(own, settings)}} if len(own) > 1 else {}
    return {"statements": judged, **several}
