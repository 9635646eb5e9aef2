"""An atlas in parts is read one dataset at a time, and gives what one in a file gives."""

import json

import numpy as np
import pytest
import xarray as xr

from fractalcontact import InputError, open_atlas
from fractalcontact.study.atlas import write_atlas

SETTINGS = {"rock": {"group": "hard"}, "clay": {"group": "soft"}, "silt": {"group": "soft"}}
CONFIGURATION = {"study": {"study": "test"}, "settings": SETTINGS}


def labelled(values):
    return xr.Dataset({"a": ("x", values, {"units": "mm", "long_name": "a"})})


def stages_of(number):
    return {"specimens": labelled([number, 2.0]), "closure": labelled([10.0 * number])}


@pytest.fixture
def whole(tmp_path):
    stages = {
        stage: {name: stages_of(i)[stage] for i, name in enumerate(SETTINGS)}
        for stage in ("specimens", "closure")
    }
    stages["roll_off"] = {"surfaces": labelled([5.0])}
    (tmp_path / "whole").mkdir()
    write_atlas(stages, tmp_path / "whole/atlas.nc", study="test", configuration=CONFIGURATION)
    return open_atlas(tmp_path / "whole")


@pytest.fixture
def parts(tmp_path):
    folder = tmp_path / "parts"
    (folder / "atlas").mkdir(parents=True)
    files = {}
    for i, name in enumerate(SETTINGS):
        files[name] = f"atlas/{name}.nc"
        of_specimen = {stage: {name: dataset} for stage, dataset in stages_of(i).items()}
        write_atlas(of_specimen, folder / files[name], study="test", configuration=CONFIGURATION)
    write_atlas(
        {"roll_off": {"surfaces": labelled([5.0])}},
        folder / "atlas.nc",
        study="test",
        configuration=CONFIGURATION,
        parts_in=files,
        checksums={name: {"lower": "0"} for name in files},
    )
    return open_atlas(folder / "atlas.nc")


def test_parts_and_one_file_give_the_same(whole, parts):
    assert whole.specimens == parts.specimens == tuple(sorted(SETTINGS))
    assert whole.stages == parts.stages == ("specimens", "closure", "roll_off")
    for stage in ("specimens", "closure"):
        for name in SETTINGS:
            assert whole[f"{stage}/{name}"].identical(parts[f"{stage}/{name}"])
    assert parts["roll_off/surfaces"].identical(whole["roll_off/surfaces"])
    assert "3 parts" in repr(parts).replace("in 3 parts", "3 parts")
    assert json.loads(parts.attrs["scan_checksums"]).keys() == SETTINGS.keys()


def test_a_stage_is_gone_through_by_group(parts):
    assert [name for name, _ in parts.stage("closure")] == sorted(SETTINGS)
    assert [name for name, _ in parts.stage("closure", "soft")] == ["clay", "silt"]
    assert list(parts.stage("strength")) == []
    sums = {name: float(dataset["a"].sum()) for name, dataset in parts.stage("closure")}
    assert sums == {"rock": 0.0, "clay": 10.0, "silt": 20.0}


def test_a_specimen_is_opened_and_read_when_used(whole, parts):
    for atlas in (whole, parts):
        with atlas.specimen("silt") as tree:
            assert set(tree.children) == {"specimens", "closure"}
            assert not tree["closure"]["a"].variable._in_memory
            assert np.array_equal(tree["closure"]["a"], [20.0])


def test_what_is_missing_is_named(parts, tmp_path):
    with pytest.raises(KeyError, match="closure/gneiss"):
        parts["closure/gneiss"]
    with pytest.raises(KeyError, match="gneiss"):
        parts.specimen("gneiss")
    with pytest.raises(InputError, match="no such file"):
        open_atlas(tmp_path / "nowhere")
    (tmp_path / "text.nc").write_text("no atlas")
    with pytest.raises(InputError, match="cannot be read as netCDF-4"):
        open_atlas(tmp_path / "text.nc")
    xr.Dataset().to_netcdf(tmp_path / "other.nc")
    with pytest.raises(InputError, match="no atlas"):
        open_atlas(tmp_path / "other.nc")
