"""The atlas of a study from its stages, with the paper's statements judged."""

from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from ..statements.judge import judge
from ..study.atlas import write_atlas


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
    judged = {}
    # A label is only words: no job before this one has it, so that a new one solves nothing again.
    for name, dataset in stages.get("specimens", {}).items():
        dataset.attrs["label"] = configuration["settings"][name]["label"]
    for name, settings in configuration["settings"].items():
        # Measured contact maps, the study's, stand under names of their own.
        of_joint = {stage: parts[name] for stage, parts in stages.items() if name in parts}
        judged[name] = judge(of_joint, settings)
    everything = {**stages, "statements": judged} if judged else stages
    study = configuration["study"]["study"]
    return write_atlas(
        everything, path, study=study, configuration=configuration, made_with=made_with
    )
