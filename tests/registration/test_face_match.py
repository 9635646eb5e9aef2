"""The coarse match of two faces on oblong cells, turned, and without their longest waves."""

import numpy as np
import pytest
from scanned_pairs import labelled
from scipy import ndimage

from fractalcontact.registration.face_match import best_match, for_comparison
from fractalcontact.registration.surface_motion import Motion, Surface, grid_nodes


def rough(shape, smooth=2.0, seed=1):
    noise = np.random.default_rng(seed).normal(size=shape)
    heights = ndimage.gaussian_filter(noise, smooth, mode="wrap")
    return heights / heights.std()


@pytest.mark.parametrize("spacing", [(0.1, 0.3), (0.3, 0.1)])
def test_a_shift_by_cells_is_found_whichever_side_of_them_is_longer(spacing):
    dx, dy = spacing
    whole = rough((60, 72))
    lower = labelled(whole[8:53, 8:65], 8 * dx, 8 * dy, spacing)
    # The upper face lies three cells too far East and five too far South.
    upper = labelled(whole[8:53, 8:65], 11 * dx, 3 * dy, spacing)
    motion, correlation = best_match(lower, upper, (0.0,))
    np.testing.assert_allclose(motion.shift, (-3 * dx, 5 * dy), atol=1e-9)
    assert correlation == pytest.approx(1.0)


@pytest.mark.parametrize("along", ["x", "y"])
def test_a_turned_strip_is_compared_to_its_ends(along):
    """A strip of ten times its width: turned by 12 degrees it reaches twice its width further."""
    whole = labelled(rough((220, 220)), spacing=(0.1, 0.1))
    strip = np.zeros((200, 20)) if along == "y" else np.zeros((20, 200))
    x0, y0 = (11 - 0.05 * n for n in strip.shape[::-1])
    empty = labelled(strip, x0, y0)
    x, y = grid_nodes(empty)
    turn = Motion((x.mean(), y.mean()), (x.mean(), y.mean()), np.radians(12))
    heights = Surface(whole)(*turn.forth(x, y))
    far = np.hypot(x - x.mean(), y - y.mean()) > 6
    heights[far] = rough(strip.shape, seed=2)[far]  # other rock beyond
    motion, correlation = best_match(whole, empty.copy(data=heights), (np.radians(12),))
    np.testing.assert_allclose(motion.shift, (0, 0), atol=0.1)
    assert correlation == pytest.approx((~far).mean(), abs=0.1)


@pytest.mark.parametrize("step", [(2, 1), (1, 2)])
def test_waves_are_taken_off_by_their_length_in_mm(step):
    """Of oblong cells what is left is that of square ones at the same places."""
    every = tuple(slice(None, None, one) for one in step)
    fine = rough((96, 96), 4.0) + rough((96, 96), 12.0, seed=3)
    square = labelled(fine)
    oblong = labelled(fine[every], spacing=(0.1 * step[1], 0.1 * step[0]))
    expected = for_comparison(square, square)[0].values[every]
    found = for_comparison(oblong, oblong)[0].values
    assert (found - expected).std() < 0.1 * expected.std()
