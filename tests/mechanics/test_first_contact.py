"""The scatter of the highest node: known for exponential heights, in the heights' own unit."""

import numpy as np
import pytest
from scipy import stats

from fractalcontact.mechanics.first_contact import highest_node_scatter
from fractalcontact.surface.synthesis import self_affine


def test_the_highest_of_exponential_heights_scatters_as_stated():
    rng = np.random.default_rng(1)
    heights = rng.exponential(0.3, size=(200, 40, 40))
    highest = heights.max(axis=(1, 2))
    low, high = np.quantile(highest, [0.025, 0.975])
    stated = [highest_node_scatter(h) for h in heights]
    assert np.median(stated) == pytest.approx((high - low) / 2, rel=0.25)


def test_the_scale_of_exponential_block_maxima_comes_back_in_the_mean():
    """Of exponential values the mean excess over any of them has the mean of their scale."""
    rng = np.random.default_rng(2)
    stated = [highest_node_scatter(h) for h in rng.exponential(0.3, size=(2000, 8, 8))]
    half_of_gumbel = np.diff(stats.gumbel_r.ppf([0.025, 0.975], scale=0.3)).item() / 2
    assert np.mean(stated) == pytest.approx(half_of_gumbel, rel=0.03)


def test_it_covers_the_highest_node_of_other_surfaces():
    fields = [self_affine((64, 64), 0.1, 0.8, rms=0.5, seed=s, roll_off=1.0) for s in range(40)]
    highest = np.array([h.max() for h in fields])
    stated = np.array([highest_node_scatter(h) for h in fields])
    assert np.mean(abs(highest - np.median(highest)) < stated) >= 0.9


def test_unit_and_level_do_not_matter_and_few_nodes_say_nothing():
    h = self_affine((32, 48), 0.1, 0.8, rms=0.5, seed=1)
    assert highest_node_scatter(1e-3 * h + 7) == pytest.approx(1e-3 * highest_node_scatter(h))
    assert np.isnan(highest_node_scatter(h[:3, :3]))
    assert highest_node_scatter(np.zeros((20, 20))) == 0
