"""Dimension of the composite topography over fixed lags."""

import numpy as np
import pytest

from fractalcontact.joint.lag_dimension import LAG_RANGES, lag_dimensions
from fractalcontact.surface.synthesis import self_affine


@pytest.fixture(scope="module")
def face():
    return self_affine((512, 512), hurst=0.8, spacing=0.1, rms=0.3, seed=1)


def dimensions(composites, spacing=(0.1, 0.1), longest=2.0):
    found = lag_dimensions(composites, spacing, longest)
    return found["lag_dimension"][1], found["lag_min"][1], found["lag_max"][1]


def test_it_falls_from_a_derivative_to_the_face_as_the_offset_grows(face):
    composites = [face[:, v : 456 + v] - face[:, :456] for v in (1, 4, 16, 56)]
    values, *_ = dimensions(composites)
    assert values.shape == (4, len(LAG_RANGES))
    assert (np.diff(values, axis=0) < 0).all()
    # Far below the lags the composite is a derivative, which is nearly as rough as noise.
    assert values[0, 0] > 2.7
    own, *_ = dimensions([face[:, :456]])
    assert values[-1, 1] == pytest.approx(own[0, 1], abs=0.1)


def test_ranges_share_their_middle_and_keep_the_unit(face):
    _, first, last = dimensions([face[:128, :128]])
    assert last[1] == first[2]
    assert (first[0], last[0]) == (first[1], last[2])
    scaled, first_um, last_um = dimensions([1e3 * face[:128, :128]], (100.0, 100.0), 2000.0)
    plain, *_ = dimensions([face[:128, :128]])
    np.testing.assert_allclose(scaled, plain, rtol=1e-9)
    np.testing.assert_allclose(first_um, 1e3 * first)
    np.testing.assert_allclose(last_um, 1e3 * last)


def test_flush_faces_have_none():
    values, *_ = dimensions([np.zeros((64, 64))])
    assert np.isnan(values).all()
