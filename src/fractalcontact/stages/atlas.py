"""The atlas of a study from its stages, with the paper's statements judged."""

import json
from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from ..core.netcdf import versions
from ..statements.comparison import UNGROUPED, compare_specimens, specimen_row
from ..statements.judge import judge
from ..statements.study import judge_study
from ..study.atlas import words_of, write_atlas
from ..study.atlas_parts import read_group

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
        settings = configuration["settings"][name]
        dataset.attrs["label"] = settings["label"]
        dataset.attrs["group"] = settings.get("group") or UNGROUPED
    # Measured contact maps, the study's, stand under names of their own.
    of_joints = {
        name: {stage: parts[name] for stage, parts in stages.items() if name in parts}
        for name in configuration["settings"]
    }
    compared = _compared(of_joints, configuration["settings"])
    everything = {**stages, **_judged(of_joints, configuration), **compared}
    study = configuration["study"]["study"]
    return write_atlas(
        _without_remade_fields(everything),
        path,
        study=study,
        configuration=configuration,
        made_with=made_with,
    )


def join_parts(
    parts: Mapping[str, Path],
    stages: Mapping[str, Mapping[str, xr.Dataset]],
    path: Path | str,
    configuration: Mapping,
    made_with: Mapping[str, Mapping[str, dict]] | None = None,
) -> dict[str, list[str]]:
    """Write what specimens whose atlases are files of their own have together.

    Of each only its row of the comparison is read, one after the other.

    Parameters
    ----------
    parts : mapping of str to Path
        Atlas of each specimen, from :func:`join_stages`, below the folder of ``path``.
    stages : mapping of str to mapping of str to xr.Dataset
        Of the study: what it has once, and measured contact maps.
    path, configuration, made_with
        As of :func:`join_stages`.

    Returns
    -------
    dict of str to list of str
        As :func:`study.atlas.write_atlas` gives it; of parts those that differ from the versions in
        use.
    """
    rows: dict[str, xr.Dataset] = {}
    checksums: dict[str, dict[str, str]] = {}
    differing: dict[str, list[str]] = {}
    for name, part in sorted(parts.items()):
        rows[name], attrs = read_group(part, f"comparison/{name}")
        checksums |= json.loads(attrs["scan_checksums"])
        if attrs["versions"] != json.dumps(versions()):
            differing.setdefault(words_of(json.loads(attrs["versions"])), []).append(name)
        for words, names in json.loads(attrs.get("versions_differ", "{}")).items():
            differing.setdefault(words, []).extend(names)
    folder = Path(path).parent
    compared = {"study_comparison": {WHOLE: compare_specimens(rows)}}
    return write_atlas(
        {**stages, **compared},
        path,
        study=configuration["study"]["study"],
        configuration=configuration,
        made_with=made_with,
        parts_in={name: part.relative_to(folder).as_posix() for name, part in parts.items()},
        checksums=checksums,
        differing=differing,
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


def _compared(of_joints, settings):
    """The row of every specimen and, where there are several, all of them side by side."""
    if not of_joints:
        return {}
    rows = {name: specimen_row(stages, settings[name]) for name, stages in of_joints.items()}
    several = {"study_comparison": {WHOLE: compare_specimens(rows)}} if len(rows) > 1 else {}
    return {"comparison": rows, **several}


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
