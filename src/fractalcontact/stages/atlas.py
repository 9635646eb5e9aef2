"""Atlas of a study from its stages, with the verdicts over specimens."""

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from ..core.netcdf import versions
from ..domain.map_series import with_series
from ..statements.comparison import UNGROUPED, compare_specimens
from ..statements.study import judge_study
from ..study.atlas import words_of, write_atlas
from ..study.atlas_parts import read_group

#: Group of the stages of the study as a whole.
WHOLE = "study"


def join_stages(
    stages: Mapping[str, Mapping[str, xr.Dataset]],
    path: Path | str,
    configuration: Mapping,
    made_with: Mapping[str, Mapping[str, dict]] | None = None,
) -> dict[str, list[str]]:
    """Write stages into one atlas, with the verdicts and comparison over specimens.

    Parameters
    ----------
    stages : mapping of str to mapping of str to xr.Dataset
        Stage to specimen to dataset.
    path : path-like
    configuration : mapping
        ``study``, as its user wrote it, and ``settings`` by specimen, from
        :func:`study.configuration.resolve_settings`.
    made_with : mapping of str to mapping of str to dict, optional
        Versions of libraries. This and the result are those of :func:`study.atlas.write_atlas`.
    """
    # Labels are added here: no job that solves takes one, so a new label solves nothing again.
    for name, dataset in stages.get("specimens", {}).items():
        settings = configuration["settings"][name]
        dataset.attrs["label"] = settings["label"]
        dataset.attrs["group"] = settings.get("group") or UNGROUPED
    everything = {**stages, **_maps(stages), **_together(stages, configuration["settings"])}
    study = configuration["study"]["study"]
    return write_atlas(
        _without_remade_fields(everything),
        path,
        study=study,
        configuration=configuration,
        made_with=made_with,
    )


def row_of(path: Path | str, name: str) -> xr.Dataset:
    """Row of the comparison of a specimen, from an atlas of its own that :func:`join_stages` wrote.

    The attributes ``scan_checksums`` and ``versions_differ`` of the row go into the atlas of all
    specimens.
    """
    row, attrs = read_group(path, f"comparison/{name}")
    kept = {key: attrs[key] for key in ("scan_checksums", "versions_differ") if key in attrs}
    return row.drop_encoding().assign_attrs(kept)


def join_rows(
    rows: Mapping[str, tuple[xr.Dataset, Mapping[str, str]]],
    stages: Mapping[str, Mapping[str, xr.Dataset]],
    path: Path | str,
    configuration: Mapping,
    made_with: Mapping[str, Mapping[str, dict]] | None = None,
) -> dict[str, list[str]]:
    """Write the common part of an atlas in parts.

    ``rows`` has by specimen what :func:`row_of` gives, and the versions that the row was made with;
    their atlases are ``atlas/SPECIMEN.nc`` below the folder of ``path``. ``stages`` has what the
    study has once, and measured contact maps. The rest is as of :func:`join_stages`.
    """
    checksums: dict[str, dict[str, str]] = {}
    differing: dict[str, list[str]] = {}
    for name, (row, used) in sorted(rows.items()):
        checksums |= json.loads(row.attrs["scan_checksums"])
        if used != versions():
            differing.setdefault(words_of(used), []).append(name)
        for words, parts in json.loads(row.attrs.get("versions_differ", "{}")).items():
            differing.setdefault(words, []).extend(parts)
    compared = compare_specimens({name: row for name, (row, _) in rows.items()})
    return write_atlas(
        {**stages, **_maps(stages), "study_comparison": {WHOLE: compared}},
        path,
        study=configuration["study"]["study"],
        configuration=configuration,
        made_with=made_with,
        parts_in={name: f"atlas/{name}.nc" for name in rows},
        checksums=checksums,
        differing=differing,
    )


def _without_remade_fields(stages):
    """Stages with composite topographies at two offsets: the largest, and that of the contact maps.

    Composites are the bulk of an atlas. The file of the stage keeps all of them.
    """
    joints = {}
    for name, joint in stages.get("joints", {}).items():
        kept = [joint["offset"].max().item()]
        if name in stages.get("contact", {}):
            kept.append(stages["contact"][name].attrs["map_offset"])
        drawn = np.isclose(joint["offset"].values[:, np.newaxis], kept, rtol=1e-9).any(axis=1)
        joints[name] = joint.assign(
            composite=joint["composite"].where(xr.DataArray(drawn, dims="offset"))
        )
    return {**stages, "joints": joints} if joints else stages


def _maps(stages):
    """Measured contact maps with their place in their series."""
    maps = stages.get("contact_maps", {})
    return {"contact_maps": with_series(maps)} if maps else {}


def _together(stages, settings):
    """Verdicts and comparison of several specimens; empty for a single one."""
    if len(stages.get("comparison", {})) < 2:
        return {}
    together = {"study_comparison": {WHOLE: compare_specimens(stages["comparison"])}}
    own = {
        # Measured contact maps belong to the study and are not among the stages of a specimen.
        name: {stage: parts[name] for stage, parts in stages.items() if name in parts}
        for name, stated in settings.items()
        if not (stated["capped_variant"] or stated["known_contact"])
    }
    if len(own) > 1:
        together["study_statements"] = {WHOLE: judge_study(own, settings)}
    return together
