"""Gap of two faces as scanned: overlap by region, and a histogram that loses no cell."""

import numpy as np
import xarray as xr

from fractalcontact.roughness.face_gap import GAP_BINS, gap_statistics


def test_overlap_and_histogram_are_those_of_the_cells():
    rng = np.random.default_rng(3)
    gap = rng.normal(0.1, 0.1, (20, 30))
    gap[0, :5] = np.nan
    lower = rng.normal(size=gap.shape)
    dims = ("y", "x")
    specimen = xr.Dataset(
        {"lower": (dims, lower), "upper": (dims, lower + gap), "overlap": (dims, gap < 0)},
        attrs={"window_y0": 4, "window_x0": 6, "window_ny": 10, "window_nx": 12},
    )
    found = xr.Dataset(gap_statistics(specimen))
    within = gap[4:14, 6:18]
    for place, part in enumerate((gap, within)):
        one = found.isel(region=place)
        measured = part[np.isfinite(part)]
        assert one["overlap_cells"] == np.sum(measured < 0)
        np.testing.assert_allclose(one["overlap_fraction"], np.mean(measured < 0))
        np.testing.assert_allclose(one["overlap_depth"], -measured.min())
        np.testing.assert_allclose(one["gap_mean"], measured.mean())
        np.testing.assert_allclose(one["gap_sd"], measured.std())
    edges, cells = found["gap_edge"].values, found["gap_cells"].values
    assert cells.sum() == np.isfinite(gap).sum()
    assert np.abs(edges).min() < 1e-12
    assert GAP_BINS <= len(cells) <= GAP_BINS + 2
    np.testing.assert_allclose(found["gap"], (edges[1:] + edges[:-1]) / 2)


def test_faces_that_lie_flush_have_one_bin():
    flat = xr.DataArray(np.zeros((8, 8)), dims=("y", "x"))
    attrs = {"window_y0": 0, "window_x0": 0, "window_ny": 8, "window_nx": 8}
    specimen = xr.Dataset({"lower": flat, "upper": flat, "overlap": flat > 0}, attrs=attrs)
    found = xr.Dataset(gap_statistics(specimen))
    assert found["gap_cells"].sum() == 64
    assert (found["overlap_depth"] == 0).all()
