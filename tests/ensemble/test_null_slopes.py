"""Local slopes of realisations and of their null models: those of one domain, and of its cut."""

import numpy as np

from fractalcontact.domain.null_models import bearing_area_cut, null_models
from fractalcontact.ensemble.null_slopes import NULL_SLOPES, null_slopes
from fractalcontact.surface.synthesis import self_affine

SHAPE = (120, 100)
HEIGHTS = self_affine(SHAPE, 0.1, 0.8, rms=0.3, seed=1)
CUTS = np.array([bearing_area_cut(HEIGHTS, nodes) for nodes in (40, 400, 4000)])
OTHERS = np.array(
    [bearing_area_cut(self_affine(SHAPE, 0.1, 0.5, rms=0.3, seed=2), n) for n in (40, 400, 4000)]
)


def test_slopes_are_those_that_one_domain_is_compared_by():
    found, alone = null_slopes(OTHERS, HEIGHTS, 0.1), null_models(OTHERS, 0.1, HEIGHTS)
    for name in ("local_slope", "local_slope_cut", "local_slope_cut_difference"):
        np.testing.assert_allclose(found[name], alone[name], err_msg=name)
    np.testing.assert_allclose(found["local_slope_side"], alone["local_slope_side"])
    # Drawn nodes scatter about what is expected of them, the less the more there are.
    np.testing.assert_allclose(
        found["local_slope_random"][1:], alone["local_slope_random"][1:], atol=0.05
    )


def test_differences_are_those_of_the_domain_less_its_null_models():
    found = null_slopes(OTHERS, HEIGHTS, 0.1)
    for null in ("random", "cut"):
        apart = found["local_slope"] - found[f"local_slope_{null}"]
        np.testing.assert_allclose(found[f"local_slope_{null}_difference"], apart)
    # A line has a lower dimension than the patches of its cut, a rectangle a higher one.
    shapes = np.zeros((2, *SHAPE), bool)
    shapes[0, 60] = shapes[1, 20:100, 20:80] = True
    line, rectangle = null_slopes(shapes, HEIGHTS, 0.1)["delta_sigma_cut_difference"].values
    assert line < -0.02
    assert rectangle > 0.1


def test_a_cut_does_not_differ_from_itself():
    found = null_slopes(CUTS, HEIGHTS, 0.1)
    assert not found["local_slope_cut_difference"].any()
    # Forty nodes follow no law.
    np.testing.assert_allclose(found["delta_sigma_cut_difference"], [np.nan, 0, 0], atol=1e-12)


def test_no_contact_and_a_window_too_small_have_no_slopes():
    nothing = null_slopes(np.zeros((1, *SHAPE), bool), HEIGHTS, 0.1)
    small = null_slopes(CUTS[:, :20, :20], HEIGHTS[:20, :20], 0.1)
    for found in (nothing, small):
        for name in NULL_SLOPES:
            assert "random" in name or found[name].isnull().all(), name
    assert small["local_slope"].shape == (3, 1)
