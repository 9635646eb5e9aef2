"""One table over all contact domains: what has a dimension and what has not."""

import numpy as np
import pytest
import xarray as xr

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
    curves = xr.Dataset({"area": nodes * (nodes["resolution"] * SPACING) ** 2})
    result = scaling_over_resolutions(curves, domains, SPACING)
    assert np.isnan(result.delta_sigma).all()  # two resolutions tell no error
    assert result.n.values.ravel().tolist() == [0, 0, 0, 2, 2]
    assert np.isnan(result.difference).all()
    assert not result.disagree.any()
