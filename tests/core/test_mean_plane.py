"""Heights less their least-squares plane."""

import numpy as np
import pytest

from fractalcontact.core.mean_plane import without_mean_plane, without_mean_planes

Y, X = np.indices((7, 9), dtype=float)
ROUGH = np.random.default_rng(4).normal(size=Y.shape)


def residual(heights):
    """The same by a general least-squares solver."""
    measured = np.isfinite(heights)
    terms = np.column_stack([Y[measured], X[measured], np.ones(measured.sum())])
    plane = np.linalg.lstsq(terms, heights[measured], rcond=None)[0]
    return heights - (plane[0] * Y + plane[1] * X + plane[2])


@pytest.mark.parametrize("holes", [0, 12])
def test_it_is_the_residual_of_least_squares(holes):
    heights = ROUGH + 3 * Y - 0.5 * X + 100
    heights.flat[np.random.default_rng(5).choice(heights.size, holes, replace=False)] = np.nan
    np.testing.assert_allclose(without_mean_plane(heights), residual(heights), atol=1e-12)


def test_a_plane_leaves_nothing_and_a_tilt_changes_nothing():
    assert np.abs(without_mean_plane(2 * Y - X + 5)).max() < 1e-13
    np.testing.assert_allclose(without_mean_plane(ROUGH + Y), without_mean_plane(ROUGH), atol=1e-13)


def test_many_grids_are_levelled_each_by_itself():
    stack = np.stack([ROUGH, ROUGH + 4 * X, -ROUGH])
    for levelled, heights in zip(without_mean_planes(stack), stack, strict=True):
        np.testing.assert_array_equal(levelled, without_mean_planes(heights))


def test_cells_that_span_no_plane_have_none():
    heights = np.full(Y.shape, np.nan)
    assert np.isnan(without_mean_plane(heights)).all()
    heights[3] = X[3]
    assert np.isnan(without_mean_plane(heights)).all()
    heights[5, 0] = 1
    assert np.isfinite(without_mean_plane(heights)).sum() == X.shape[1] + 1
    assert np.isnan(without_mean_plane(np.where(Y == X, ROUGH, np.nan))).all()  # on a slanted line
