"""The stage contact: coordinates, missing states, and fields at the offset of the maps."""

import numpy as np
import pytest
import xarray as xr
from made_settings import made_settings

from fractalcontact.core import netcdf
from fractalcontact.core.window import nominal_area
from fractalcontact.joint.joint import composite_topography, describe_joint, offsets_of
from fractalcontact.states.contact_fields import NOT_SOLVED, contact_fields
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.states import combine, contact_domains
from fractalcontact.states.sweep import joint_states
from fractalcontact.study.atlas import read_atlas, write_atlas
from fractalcontact.study.configuration import solver_settings
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SETTINGS = made_settings(
    directions=["E", "W"],
    contact_directions=["W", "E"],
    offsets=[0.6, 0.3],
    loads=[(1.0, "pressure"), (5.0, "pressure"), (25.0, "pressure")],
    dilatancy_loads=[(5.0, "pressure")],
    map_load=(25.0, "pressure"),
    map_offset=0.3,
    resolutions=[1, 2],
    surface_range=None,
)


@pytest.fixture(scope="module")
def made():
    """Specimen, joint, the dataset of the solved domains, and the stage made of it."""
    heights = self_affine((48, 48), 0.1, 0.8, seed=3, rms=0.1)
    coords = {axis: 0.1 * (np.arange(48) + 0.5) for axis in "yx"}
    attrs = {"spacing_y": 0.1, "spacing_x": 0.1}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    specimen = make_specimen(scan, window=2.4, name="rock", multiple=2)
    joint = describe_joint(specimen, SETTINGS)
    solver = solver_settings({}, "study")
    parts = [
        joint_states(specimen, joint, [direction], slice(None), SETTINGS, [1, 2], solver)
        for direction in SETTINGS.contact_directions
    ]
    domains = contact_domains(combine(parts))
    stage = contact_fields(domains, parts, joint, SETTINGS, nominal_area(specimen))
    return specimen, joint, domains, stage


@pytest.fixture
def read_back(made, tmp_path):
    """The stage as a user reads it from the atlas."""
    path = tmp_path / "atlas.nc"
    netcdf.write(made[3], tmp_path / "contact.nc")
    stage = netcdf.read(tmp_path / "contact.nc")
    parts = {"contact": {"rock": stage}}
    write_atlas(parts, path, study="s", configuration={})
    return path


def test_states_that_were_not_solved_are_missing_and_not_empty(made, read_back):
    _, _, domains, _ = made
    contact = read_atlas(read_back)["contact/rock"].to_dataset()
    assert not contact["solved"].all()
    for factor in (1, 2):
        field = contact[f"in_contact_{factor}"]
        solved = contact["solved"].sel(resolution=factor)
        missing = field.isnull().all([f"y_{factor}", f"x_{factor}"])
        xr.testing.assert_equal(missing, ~solved.transpose(*missing.dims).drop_vars("resolution"))
        truth = domains[f"in_contact_{factor}"]
        np.testing.assert_array_equal((field == 1).values, truth.values)
        nodes = field.sum([f"y_{factor}", f"x_{factor}"], min_count=1)
        assert np.isnan(nodes.where(~solved)).all()
        assert (nodes.where(solved, 1) > 0).all()
    # In the file they are bytes, which any reader of netCDF takes for missing.
    import netCDF4

    with netCDF4.Dataset(read_back) as file:
        stored = file["contact/rock/in_contact_1"]
        assert stored.dtype == np.int8
        assert stored._FillValue == NOT_SOLVED


def test_nodes_lie_where_the_scan_has_them(made):
    specimen, joint, _, stage = made
    for factor in (1, 2):
        for axis in "yx":
            places = stage[f"{axis}_{factor}"]
            np.testing.assert_array_equal(places, joint[f"window_{axis}"][::factor])
            assert places.attrs["units"] == "mm"
            assert set(np.round(places.values, 9)) <= set(np.round(specimen[axis].values, 9))


def test_pressure_and_gap_belong_to_the_state_of_the_maps(made):
    specimen, _, _, stage = made
    assert stage.attrs["map_direction"] == "W"
    assert stage.attrs["map_offset"] == 0.3
    assert stage.attrs["map_load"] == pytest.approx(25 * 2.4**2)
    place = {"direction": "W", "offset": stage.attrs["map_offset"]}
    touching = stage["in_contact_1"].sel(place) == 1
    pressure, gap = stage["map_pressure"], stage["map_gap"]
    assert pressure.dtype == gap.dtype == np.float32
    np.testing.assert_array_equal(pressure > 0, touching)
    forces = pressure.sum(["y_1", "x_1"]) * 0.01
    np.testing.assert_allclose(forces, stage["normal_force"], rtol=1e-4)
    kept = gap.notnull().all(["y_1", "x_1"])
    assert kept.values.tolist() == [False, True, True]
    assert float(abs(gap.where(touching)).max()) < 1e-4 * float(gap.max())
    # Opposite in sign and form to the composite topography, and smoother by the displacement.
    loading = JointLoading(specimen, "W", [3], SETTINGS, solver_settings({}, "study"))
    assert loading.offsets.tolist() == [0.3]
    h = composite_topography(specimen, "W", 3)
    assert np.corrcoef(gap.isel(normal_force=2).values.ravel(), -h.ravel())[0, 1] > 0.8


def test_offsets_are_found_by_their_value_and_the_nearest(made):
    _, joint, _, stage = made
    for of in (joint, stage):
        assert of["offset"].values.tolist() == [0.3, 0.6]
        assert float(of["offset"].sel(offset=0.3)) == 0.3
        assert float(of["offset"].sel(offset=0.5, method="nearest")) == 0.6


@pytest.mark.parametrize("spacing", [0.1, 0.0056858, 1e-7, 250.0])
def test_offsets_are_whole_cells_but_for_rounding(spacing):
    cells = np.array([0, 1, 3, 7, 1023])
    found = offsets_of(cells, spacing)
    np.testing.assert_allclose(found, cells * spacing, rtol=1e-11)
    np.testing.assert_allclose(offsets_of(cells, 1e3 * spacing), 1e3 * found, rtol=1e-11)
