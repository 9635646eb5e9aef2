"""Datasets as files: what is written comes back, with versions, and the same bytes every time."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core import netcdf

DATASET = xr.Dataset(
    {
        "height": (("y", "x"), np.random.default_rng(0).normal(size=(20, 30)), {"units": "mm"}),
        "state": ("y", np.array(["solved"] * 20, dtype=object)),
        "force": ((), 3.0),
    },
    coords={"x": np.arange(30.0)},
    attrs={"specimen": "granite"},
)


def test_a_dataset_comes_back_with_the_versions_it_was_made_with(tmp_path):
    path = tmp_path / "new" / "rock.nc"
    netcdf.write(DATASET, path)
    dataset, versions = netcdf.read_with_versions(path)
    xr.testing.assert_identical(dataset, DATASET)
    assert versions == netcdf.versions()
    assert versions["numpy"] == np.__version__
    xr.testing.assert_identical(netcdf.read(path), DATASET)


def test_the_same_dataset_gives_the_same_bytes(tmp_path):
    contents = []
    for name in ("a.nc", "b.nc"):
        netcdf.write(DATASET, tmp_path / name)
        contents.append((tmp_path / name).read_bytes())
    assert contents[0] == contents[1]


def test_numbers_are_compressed_and_nothing_else():
    assert set(netcdf.encoding(DATASET)) == {"height", "x"}


def test_a_dataset_that_cannot_be_written_leaves_the_old_file(tmp_path):
    path = tmp_path / "rock.nc"
    netcdf.write(DATASET, path)
    before = path.read_bytes()
    with pytest.raises(Exception, match="object"):
        netcdf.write(DATASET.assign(odd=("y", [object()] * 20)), path)
    assert path.read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == ["rock.nc"]


def test_other_texts_may_be_longer_than_those_that_were_read(tmp_path):
    """A kept encoding would cut them off."""
    netcdf.write(DATASET, tmp_path / "rock.nc")
    dataset = netcdf.read(tmp_path / "rock.nc")
    longer = dataset.assign(state=("y", np.array(["not converged"] * 20, dtype=object)))
    netcdf.write(longer, tmp_path / "longer.nc")
    assert netcdf.read(tmp_path / "longer.nc").state[0] == "not converged"
