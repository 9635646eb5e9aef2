"""Random nodes and bearing-area cuts beside contact domains, and what may be called fractal."""

import numpy as np
import pytest
from ensembles import ensemble
from known_sets import cantor_dust, percolation_cluster, sierpinski_carpet

from fractalcontact.core.verdicts import (
    BEYOND_BOTH,
    BEYOND_RANDOM,
    LIKE_CUT,
    LIKE_RANDOM,
    UNDETERMINED,
)
from fractalcontact.domain.box_counts import mean_count, whole_sizes
from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.domain.departure import departure_of
from fractalcontact.domain.mean_law import find_law
from fractalcontact.domain.null_models import bearing_area_cut, null_models
from fractalcontact.domain.random_nodes import (
    band_of,
    expected_dimension,
    expected_mean_counts,
    random_bands,
    random_nodes,
)
from fractalcontact.domain.slope_curves import Departure
from fractalcontact.surface.synthesis import self_affine


def scattered(shape, nodes, seed):
    cells = np.arange(np.prod(shape)) < nodes
    return np.random.default_rng([99, seed]).permutation(cells).reshape(shape)


# -- exact -----------------------------------------------------------------------------------------


def test_one_random_node_fills_the_places_of_one_box():
    np.testing.assert_allclose(expected_mean_counts((9, 7), 1, np.array([1, 2, 5])), 1)


def test_expected_counts_of_a_full_window_are_its_own():
    sizes = np.array([1, 3, 4])
    expected = mean_count(np.ones((9, 7), bool), sizes).sum(axis=(1, 2))
    np.testing.assert_allclose(expected_mean_counts((9, 7), 63, sizes), expected)


def test_cut_holds_the_highest_nodes():
    heights = self_affine((40, 30), 1.0, 0.7, rms=1.0, seed=0)
    cut = bearing_area_cut(heights, 25)
    assert cut.sum() == 25
    assert heights[cut].min() > heights[~cut].max()
    level = bearing_area_cut(np.array([[1.0, 2.0, np.nan], [2.0, 2.0, 0.0]]), 2)
    assert level.tolist() == [[False, True, False], [True, False, False]]


def test_band_is_that_of_one_more_normal_draw():
    # t of 4 degrees of freedom 2.776, standard deviation 1.5811, root of 1 + 1/5.
    band = band_of(np.array([1.0, 2, 3, 4, 5]))
    np.testing.assert_allclose(band.ends, (3, 3 - 4.8090, 3 + 4.8090), atol=1e-3)
    assert np.isnan(band_of(np.array([1.0, np.nan, np.nan, np.nan])).ends).all()


DEPARTURES = [
    ((0.005, 0.3), (0.05, 0.1), True, BEYOND_BOTH),
    ((0.05, 0.3), (0.06, 0.3), True, LIKE_CUT),
    # Significant differences that are too small to matter.
    ((0.05, 0.3), (1e-9, 0.002), True, LIKE_CUT),
    ((0.005, 0.01), (0.001, 0.3), True, LIKE_RANDOM),
    ((0.055, 0.3), (0.001, 0.3), True, LIKE_RANDOM),
    ((0.005, 0.3), (np.nan, np.nan), True, UNDETERMINED),
    ((0.005, 0.3), (np.nan, np.nan), False, BEYOND_RANDOM),
    ((np.nan, np.nan), (0.001, 0.3), True, UNDETERMINED),
]


@pytest.mark.parametrize(("random", "cut", "surface", "expected"), DEPARTURES)
def test_departure_is_what_both_nulls_say(random, cut, surface, expected):
    departures = (Departure(p, 0, size) for p, size in (random, cut))
    assert departure_of(*departures, surface=surface) == expected


# -- independent -----------------------------------------------------------------------------------


def test_the_dimension_expected_of_random_nodes_is_that_of_drawn_ones():
    cluster = percolation_cluster(96, seed=2)
    nodes = int(cluster.sum())
    law = find_law(cluster, (0.0, np.inf), False)
    bands, _ = random_bands(cluster.shape, nodes, law=law)
    expected = expected_dimension(cluster, 0.1)
    assert expected == pytest.approx(bands["delta_sigma"].value, abs=0.02)
    assert expected == pytest.approx(expected_dimension(cluster, 0.5))
    assert np.isnan(expected_dimension(np.zeros((20, 20), bool), 0.1))


def test_expected_counts_are_the_mean_of_draws():
    shape, nodes, draws = (24, 31), 20, 400
    sizes = whole_sizes(10)
    cells = np.arange(np.prod(shape))
    counts = np.array(
        [
            mean_count(random_nodes(shape, nodes, cells, seed), sizes).sum(axis=(1, 2))
            for seed in range(draws)
        ]
    )
    error = counts.std(axis=0, ddof=1) / np.sqrt(draws)
    expected = expected_mean_counts(shape, nodes, sizes)
    assert (np.abs(counts.mean(axis=0) - expected) <= 4 * error + 1e-9).all()


# -- properties ------------------------------------------------------------------------------------


FRACTALS = {
    "carpet": lambda seed: sierpinski_carpet((81, 200, 243)[seed % 3]),
    "dust": lambda seed: cantor_dust((81, 200, 243)[seed % 3]),
    "percolation": lambda seed: percolation_cluster(256, seed),
}


@pytest.mark.parametrize("seed", range(ensemble("fractals beside nulls")))
@pytest.mark.parametrize("name", FRACTALS)
def test_known_fractals_are_called_so(name, seed):
    found = null_models(FRACTALS[name](seed)[np.newaxis], 0.1).isel(normal_force=0)
    assert found["null_verdict"].item() == BEYOND_RANDOM
    assert np.isnan(found["delta_sigma_cut"])


def test_a_cut_is_not_distinguished_from_itself():
    heights = self_affine((96, 96), 0.1, 0.8, rms=1.0, seed=4)
    found = null_models(bearing_area_cut(heights, 500)[np.newaxis], 0.1, heights)
    found = found.isel(normal_force=0)
    for name in ("delta_sigma", "correlation_dimension"):
        assert found[f"{name}_cut_difference"] == 0
    assert found["local_slope_cut_p"] == 1
    assert found["null_verdict"].item() == LIKE_CUT


def test_the_same_question_has_the_same_answer_bit_for_bit():
    domains = scattered((64, 48), 90, 1)[np.newaxis]
    heights = self_affine((64, 48), 0.1, 0.8, rms=1.0, seed=4)
    first, second = (null_models(domains, 0.1, heights) for _ in range(2))
    assert first.identical(second)
    for variable in first.variables.values():
        assert {"units", "long_name"} <= set(variable.attrs)


def test_random_nodes_stay_within_what_was_measured():
    mask = np.zeros((40, 40), bool)
    mask[5:30, 10:35] = True
    drawn = random_nodes((40, 40), 100, np.flatnonzero(mask), 3)
    assert drawn.sum() == 100
    assert not drawn[~mask].any()
    domain = scattered((40, 40), 60, 2) & mask
    inside, outside = (null_models(domain[np.newaxis], 0.1, mask=m) for m in (mask, None))
    boxes = [found["null_count_random"].isel(null_scale=3).item() for found in (inside, outside)]
    assert boxes[0] < boxes[1] - 3


def test_unit_of_length_changes_no_null():
    domains = scattered((64, 64), 90, 1)[np.newaxis]
    mm, um = null_models(domains, 0.1), null_models(domains, 100.0)
    for name in ("delta_sigma", "clusters", "local_slope"):
        np.testing.assert_array_equal(mm[f"{name}_random"], um[f"{name}_random"])
    assert mm["local_slope_random_p"] == um["local_slope_random_p"]
    np.testing.assert_allclose(um["local_slope_side"], 1e3 * mm["local_slope_side"])
    np.testing.assert_allclose(um["null_side"], 1e3 * mm["null_side"])


@pytest.mark.parametrize("nodes", [0, 1])
def test_nothing_is_said_of_too_few_nodes(nodes):
    found = null_models(scattered((32, 32), nodes, 0)[np.newaxis], 0.1)
    assert found["null_verdict"].item() == UNDETERMINED
    assert np.isnan(found["delta_sigma_random"]).all()
    assert np.isnan(dimension_of_domain(scattered((32, 32), nodes, 0), 0.1).dimension)
