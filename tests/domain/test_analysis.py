"""One table over all contact domains: what has a dimension and what has not."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.intervals import LEFT_OUT
from fractalcontact.domain.analysis import analyse_domains, scaling_over_resolutions
from fractalcontact.domain.box_dimension import ONE_NODE, dimension_of_domain
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1
SHARES = (1 / 128**2, 2 / 128**2, 3 / 128**2, 0.05, 0.2)


@pytest.fixture(scope="module")
def fields():
    """The highest nodes of a surface at two resolutions; one, two and three nodes at the finest."""
    heights = self_affine((128, 128), SPACING, 0.8, rms=1.0, seed=5)
    data = {}
    for k in (1, 2):
        z = heights[::k, ::k]
        ranked = np.sort(z, axis=None)[::-1]
        levels = [ranked[max(round(share * z.size), 1) - 1] for share in SHARES]
        data[f"in_contact_{k}"] = (
            ("direction", "offset", "normal_force", f"y_{k}", f"x_{k}"),
            np.array([z >= level for level in levels])[np.newaxis, np.newaxis],
        )
    return xr.Dataset(data, coords={"direction": ["E"], "offset": [0.0], "normal_force": range(5)})


def test_each_domain_has_the_dimension_of_its_box_counts(fields):
    table = analyse_domains(fields, SPACING).isel(direction=0, offset=0)
    for k in (1, 2):
        row = table.sel(resolution=k, normal_force=4)
        domain = fields[f"in_contact_{k}"].values[0, 0, 4]
        expected = dimension_of_domain(domain, k * SPACING)
        assert row.delta_sigma.item() == expected.dimension
        assert row.delta_sigma_low.item() == expected.low
        assert row.reason.item() == ""
        assert row.box_used.sum() == expected.used.sum()


def test_few_nodes_have_no_dimension_and_a_reason(fields):
    table = analyse_domains(fields, SPACING).isel(direction=0, offset=0).sel(resolution=1)
    few = table.isel(normal_force=slice(3))
    assert np.isnan(few.delta_sigma).all()
    assert np.isnan(few.delta_sigma_low).all()
    assert (few.fit_n == 0).all()
    assert few.reason.values[0] == ONE_NODE
    assert (few.reason != "").all()
    assert few.box_count.isel(scale=0).values.tolist() == [1, 2, 3]  # counted all the same
    assert np.isfinite(table.delta_sigma.values[3:]).all()


def test_missing_dimension_is_not_compared(fields):
    domains = analyse_domains(fields, SPACING)
    nodes = xr.concat(
        [fields[f"in_contact_{k}"].sum([f"y_{k}", f"x_{k}"]) for k in (1, 2)], "resolution"
    ).assign_coords(resolution=[1, 2])
    curves = curves_of(nodes)
    result = scaling_over_resolutions(curves, domains, SPACING)
    assert np.isnan(result.delta_sigma).all()  # two resolutions tell no error
    enough = (nodes >= 30).sum("resolution").values.ravel()
    np.testing.assert_array_equal(result.n.values.ravel(), enough)
    assert 0 < enough.max() < 3
    assert np.isnan(result.difference).all()
    assert not result.disagree.any()


def curves_of(nodes, corrected=0.8):
    """Nodes of contact domains as the closure stage has them, corrected areas a fraction of raw."""
    area = nodes * (nodes["resolution"] * SPACING) ** 2
    sampling = 1 / np.sqrt(nodes)
    table = {"nodes": nodes, "area": area, "area_corrected": corrected * area}
    return xr.Dataset(table | {"area_sampling": sampling})


def scaled(fields, nodes, corrected=0.8, **how):
    """Renormalisation of contact domains with these nodes at resolutions 1, 2, 4, 8."""
    nodes = xr.DataArray(
        np.reshape(nodes, (1, 1, -1, 1)),
        dims=("direction", "offset", "resolution", "normal_force"),
        coords={"resolution": [1, 2, 4, 8], "normal_force": [10.0]},
    ).assign_coords(direction=fields["direction"], offset=fields["offset"])
    domains = analyse_domains(fields, SPACING).isel(normal_force=[0])
    domains = domains.assign_coords(normal_force=[10.0])
    return scaling_over_resolutions(curves_of(nodes, corrected), domains, SPACING, **how).squeeze()


def test_dimension_is_that_of_the_corrected_area(fields):
    factors = np.array([1, 2, 4, 8])
    nodes = np.array([6400, 1600, 400, 100])
    # An excess that grows with the spacing makes the raw area rise: its dimension is too low.
    corrected = xr.DataArray(factors**-0.1, dims="resolution")
    left = 1 - np.outer(1 / np.arange(20, 30), factors**0.1)
    left = xr.DataArray(left, dims=(LEFT_OUT, "resolution"))
    result = scaled(fields, nodes * factors**0.4, corrected, left=left)
    assert result["delta_sigma"].item() == pytest.approx(2 - 0.3)
    assert result["delta_sigma_low"] < result["delta_sigma"] < result["delta_sigma_high"]
    np.testing.assert_allclose(result["sigma_n"] * result["area_corrected"], 10.0)


def test_resolutions_of_few_nodes_are_in_no_fit(fields):
    result = scaled(fields, [900, 300, 100, 29])
    assert result["n"] == 3
    assert result["delta_sigma"].item() == pytest.approx(np.log(3) / np.log(2))
    assert np.isfinite(result["sigma_n"]).values.tolist() == [True, True, True, False]
    result = scaled(fields, [90, 30, 10, 3])
    assert result["n"] == 2
    assert np.isnan(result["delta_sigma"])


def test_the_real_mean_pressure_does_not_depend_on_the_spacings_that_are_fitted(fields):
    nodes = [6400, 1600, 400, 29]
    result = scaled(fields, nodes, fit_range=(2 * SPACING, 8 * SPACING))
    everywhere = scaled(fields, nodes)
    np.testing.assert_array_equal(result["sigma_n"], everywhere["sigma_n"])
    assert np.isfinite(result["sigma_n"]).values.tolist() == [True, True, True, False]
    assert everywhere["area_used"].values.tolist() == [True, True, True, False]
    assert not result["area_used"].any()  # two spacings have no slope


def test_range_of_the_study_is_that_of_the_fit(fields):
    result = scaled(fields, [6400, 1600, 400, 100], fit_range=(SPACING, 4 * SPACING))
    assert result["n"] == 3
