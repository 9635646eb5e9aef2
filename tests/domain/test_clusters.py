import itertools

import numpy as np
import pytest
from ensembles import ensemble
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from known_sets import embedded

from fractalcontact.core.determined import follows_law
from fractalcontact.domain.clusters import (
    CLUSTER_FIELDS,
    MIN_CLUSTERS,
    MIN_OCTAVES,
    cluster_sizes,
    cluster_statistics,
    elongations,
    largest_void,
    morisita_index,
    octave_counts,
    quadrat_counts,
    size_exponent,
)
from fractalcontact.surface.synthesis import self_affine


def random_domain(shape, nodes, seed):
    domain = np.zeros(shape[0] * shape[1], bool)
    domain[np.random.default_rng(seed).choice(domain.size, nodes, replace=False)] = True
    return domain.reshape(shape)


# -- exact -----------------------------------------------------------------------------------------


def test_no_contact():
    found = cluster_statistics(np.zeros((32, 32), bool), 0.1)
    assert found.pop("clusters") == found.pop("cluster_fit_n") == 0
    assert not found.pop("cluster_octaves").any()
    assert np.isnan(list(found.values())).all()


def test_full_contact():
    found = cluster_statistics(np.ones((64, 64), bool), 0.1)
    assert found["clusters"] == found["largest_share"] == 1
    assert found["cluster_area_mean"] == pytest.approx(6.4**2)
    assert found["cluster_octaves"].tolist() == [0] * 12 + [1]
    assert (found["morisita"], found["morisita_scatter"]) == (1, 0)


def test_all_contact_in_one_quadrat():
    found = cluster_statistics(embedded((64, 64), slice(8, 14), slice(0, 6)), 1.0)
    assert found["morisita"] == pytest.approx(4095 / 63)
    assert found["morisita"] > 1 + 10 * found["morisita_scatter"]


def test_checkerboard_of_cells_is_one_cluster_more_regular_than_chance():
    found = cluster_statistics(np.indices((64, 64)).sum(axis=0) % 2 == 0, 1.0)
    assert found["clusters"] == 1  # joined over the corners
    assert found["morisita"] < 1


def test_checkerboard_of_quadrats_is_localised():
    contact, cells = quadrat_counts(np.indices((64, 64)).sum(axis=0) // 8 % 2 == 0)
    assert contact.shape == cells.shape == (64,)
    found = cluster_statistics(np.kron(np.indices((8, 8)).sum(axis=0) % 2 == 0, np.ones((8, 8))), 1)
    assert found["morisita"] == pytest.approx(4095 / 2047)
    assert found["clusters"] == 1


def test_length_over_width_of_clusters():
    domain = np.zeros((20, 40), bool)
    domain[1, 2:5] = domain[4:8, 2:6] = domain[12, 3:5] = True  # a line, a square, a pair
    for n in range(4):
        domain[14 + n, 20 + n] = True  # a line over the corners
    np.testing.assert_allclose(elongations(domain)[:3], [3, 1, 2])
    assert elongations(domain)[3] > 3
    turned = elongations(domain.T)
    np.testing.assert_allclose(np.sort(turned), np.sort(elongations(domain)))
    # Of the 3 + 16 + 2 + 4 nodes those of both lines are in long clusters.
    assert cluster_statistics(domain, 0.1)["long_share"] == pytest.approx(7 / 25)


def test_the_largest_void_is_the_largest_disc_in_the_window_without_contact():
    domain = np.zeros((9, 9), bool)
    assert np.isnan(largest_void(domain, (0.5, 0.5)))
    # The edges of the window, half a cell beyond its nodes, bound the disc.
    domain[0, 0] = True
    assert largest_void(domain, (0.5, 0.5)) == pytest.approx(9 * 0.5)
    domain[4, 4] = True
    free = np.full((9, 9), np.inf)
    for y, x in np.ndindex(free.shape):
        to_edge = [y + 0.5, x + 0.5, 8.5 - y, 8.5 - x]
        free[y, x] = min(np.hypot(y, x), np.hypot(y - 4, x - 4), *to_edge)
    assert largest_void(domain, (1.0, 1.0)) == pytest.approx(2 * free.max())
    # Cells twice as wide: two of them lie between the contact and the middle of the disc.
    assert largest_void(domain, (0.5, 1.0)) == pytest.approx(4.0)
    assert largest_void(np.ones((4, 4), bool), (0.5, 0.5)) == 0


def test_octaves_begin_at_powers_of_two():
    sizes = np.array([1, 2, 3, 4, 7, 8, 2**20 - 1, 2**20])
    counts = octave_counts(sizes, 2**20)
    assert counts[:4].tolist() == [1, 2, 2, 1]
    assert counts[[19, 20]].tolist() == [1, 1]
    assert len(counts) == 21


@pytest.mark.parametrize("beta", [0.5, 1.0, 2.0])
def test_exponent_of_an_exact_power_law(beta):
    # N(a >= 2^k) = 2^(-beta k) of a million, in whole clusters.
    left = np.floor(1e6 * 2.0 ** (-beta * np.arange(24))).astype(int)
    octaves = left - np.append(left[1:], 0)
    sizes = np.repeat(2 ** np.arange(24), octaves)
    found = size_exponent(octaves, sizes, 0.01)
    assert found["cluster_exponent"] == pytest.approx(beta, rel=0.01)
    assert found["cluster_exponent_low"] < beta < found["cluster_exponent_high"]
    assert found["cluster_fit_min"] == pytest.approx(0.01 * sizes[-int(found["cluster_fit_n"])])
    assert found["cluster_fit_max"] == pytest.approx(0.01 * sizes.max())
    assert found["cluster_fit_distance"] < 0.01


def test_a_law_needs_its_fewest_clusters_and_no_more():
    counts = np.array([MIN_CLUSTERS - 7, 4, 2, 1])
    sizes = np.repeat(2 ** np.arange(MIN_OCTAVES), counts)
    assert size_exponent(counts, sizes, 1.0)["cluster_fit_n"] == MIN_CLUSTERS
    counts, sizes = counts - [1, 0, 0, 0], sizes[1:]
    assert np.isnan(size_exponent(counts, sizes, 1.0)["cluster_exponent"])


# -- independent -----------------------------------------------------------------------------------


def clusters_by_hand(domain):
    """Sizes by walking from node to neighbouring node."""
    left, sizes = set(map(tuple, np.argwhere(domain))), []
    while left:
        front, size = [left.pop()], 0
        while front:
            y, x = front.pop()
            size += 1
            around = {(y + i, x + j) for i in (-1, 0, 1) for j in (-1, 0, 1)} & left
            left -= around
            front += around
        sizes.append(size)
    return sorted(sizes)


@given(arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12))))
@settings(max_examples=60, deadline=None)
def test_clusters_agree_with_walking(domain):
    sizes = clusters_by_hand(domain)
    found = cluster_statistics(domain, 1.0)
    assert sorted(cluster_sizes(domain)) == sizes
    assert found["clusters"] == len(sizes) == found["cluster_octaves"].sum()
    if sizes:
        assert found["largest_share"] == sizes[-1] / sum(sizes)
        assert found["cluster_area_mean"] == np.mean(sizes)


@given(arrays(bool, st.tuples(st.integers(1, 30), st.integers(1, 30))))
@settings(max_examples=60, deadline=None)
def test_morisita_is_the_ratio_of_pairs_that_share_a_quadrat(domain):
    contact, cells = quadrat_counts(domain)
    assert contact.sum() == domain.sum()
    assert cells.sum() == domain.size
    index, _ = morisita_index(contact, cells)
    sharing, of_all = (
        np.sum(n * (n - 1)) / max(n.sum() * (n.sum() - 1), 1) for n in (contact, cells)
    )
    if domain.sum() < 2 or of_all == 0:
        assert np.isnan(index)
    else:
        assert index == pytest.approx(sharing / of_all)


def test_mean_and_scatter_of_morisita_over_all_sets_of_few_nodes():
    cells = np.array([2, 3, 4])
    quadrat = np.repeat(np.arange(3), cells)
    for nodes in (2, 3, 4, 6, 8):
        values = [
            morisita_index(np.bincount(quadrat[list(chosen)], minlength=3), cells)
            for chosen in itertools.combinations(range(9), nodes)
        ]
        index, scatter = np.transpose(values)
        assert index.mean() == pytest.approx(1)
        np.testing.assert_allclose(scatter, index.std(), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("shape", "nodes"), [((64, 64), 20), ((61, 50), 200), ((128, 96), 4000)])
def test_random_nodes_read_as_random(shape, nodes):
    draws = ensemble("random domains")
    found = [cluster_statistics(random_domain(shape, nodes, seed), 1.0) for seed in range(draws)]
    index = np.array([f["morisita"] for f in found])
    scatter = found[0]["morisita_scatter"]
    assert index.mean() == pytest.approx(1, abs=4 * scatter / np.sqrt(draws))
    # Of 200 draws the standard deviation is known within 5 %, so this is four times that.
    assert index.std() == pytest.approx(scatter, rel=0.2 * np.sqrt(200 / draws))


@pytest.mark.parametrize("beta", [0.6, 1.0, 1.5])
def test_interval_of_the_exponent_holds_the_truth(beta):
    rng = np.random.default_rng(5)
    held = followed = 0
    draws = ensemble("sets of power-law sizes")
    for _ in range(draws):
        sizes = np.minimum(rng.random(500) ** (-1 / beta), 2.0**39).astype(np.int64)
        found = size_exponent(octave_counts(sizes, 2**40), sizes, 1.0)
        held += found["cluster_exponent_low"] <= beta <= found["cluster_exponent_high"]
        followed += follows_law(found["cluster_fit_n"], found["cluster_fit_distance"])
    assert followed >= 0.93 * draws
    assert held >= 0.89 * draws  # 95 %, less what choosing the range costs


def test_the_limit_of_a_power_law_is_no_wider_than_chance_needs():
    """Exact laws stay within it in 95 of 100 draws, the widest ones in no more than 99."""
    rng = np.random.default_rng(7)
    followed = 0
    for _ in range(1000):
        sizes = np.minimum(rng.random(60) ** (-1 / 0.4), 2.0**39).astype(np.int64)
        found = size_exponent(octave_counts(sizes, 2**40), sizes, 1.0)
        followed += follows_law(found["cluster_fit_n"], found["cluster_fit_distance"])
    assert 950 <= followed <= 990


def test_sizes_without_a_power_law_are_told():
    rng = np.random.default_rng(5)
    sizes = np.ceil(rng.lognormal(3, 0.7, 3000)).astype(np.int64)
    found = size_exponent(octave_counts(sizes, 2**16), sizes, 1.0)
    assert np.isfinite(found["cluster_exponent"])
    assert not follows_law(found["cluster_fit_n"], found["cluster_fit_distance"])


# -- properties ------------------------------------------------------------------------------------


def test_morisita_does_not_see_how_dense_a_domain_is():
    heights = self_affine((128, 128), 1.0, 0.8, rms=1.0, seed=2, roll_off=40.0)
    domain = heights > np.quantile(heights, 0.8)
    whole = cluster_statistics(domain, 1.0)["morisita"]
    rng = np.random.default_rng(1)
    thinned = [
        cluster_statistics(domain & (rng.random(domain.shape) < 0.1), 1.0)["morisita"]
        for _ in range(ensemble("thinned domains"))
    ]
    error = np.std(thinned) / np.sqrt(len(thinned))
    assert whole > 1.5
    assert np.mean(thinned) == pytest.approx(whole, abs=4 * error)


def test_localised_contact_is_told_from_contact_spread_evenly():
    # The same clusters at random places, then all in one corner of the window.
    rng = np.random.default_rng(3)
    spread, packed = np.zeros((2, 128, 128), bool)
    for y, x in rng.integers(0, 126, (60, 2)):
        spread[y : y + 2, x : x + 2] = True
        packed[y // 3 : y // 3 + 2, x // 3 : x // 3 + 2] = True
    even, corner = (cluster_statistics(domain, 1.0) for domain in (spread, packed))
    assert corner["morisita"] > 3 * even["morisita"]


def test_unit_of_length_changes_only_areas():
    domain = self_affine((128, 128), 1.0, 0.7, rms=1.0, seed=0) > 1.0
    mm, um = cluster_statistics(domain, 0.1), cluster_statistics(domain, 100.0)
    for name, (unit, _) in CLUSTER_FIELDS.items():
        np.testing.assert_allclose(um[name], mm[name] * (1e6 if unit == "mm2" else 1))


def test_halved_cells_leave_clusters_as_they_are():
    domain = self_affine((96, 96), 1.0, 0.7, rms=1.0, seed=4)[:, :64] > 0.8
    whole = cluster_statistics(domain, 0.3)
    halved = cluster_statistics(np.kron(domain, np.ones((2, 2), bool)), 0.15)
    for name in ("clusters", "largest_share", "cluster_area_mean"):
        assert halved[name] == pytest.approx(whole[name], rel=1e-12)


def test_direction_does_not_matter():
    domain = self_affine((96, 96), 1.0, 0.7, rms=1.0, seed=4) > 0.8
    first = cluster_statistics(domain, 1.0)
    for turned in (domain.T, domain[::-1], np.rot90(domain)):
        again = cluster_statistics(turned, 1.0)
        assert again.keys() == first.keys() == {*CLUSTER_FIELDS, "cluster_octaves"}
        for name, value in first.items():
            np.testing.assert_allclose(again[name], value, rtol=1e-12)


def test_few_clusters_have_no_exponent():
    found = cluster_statistics(random_domain((64, 64), 49, 0), 1.0)
    assert np.isnan(found["cluster_exponent"])
    assert found["cluster_fit_n"] == 0
    alike = np.zeros((64, 64), bool)
    alike[::2, ::2] = True  # a thousand clusters of one node
    assert np.isnan(cluster_statistics(alike, 1.0)["cluster_exponent"])


def test_tables_of_one_window_fit_together():
    lengths = {
        len(cluster_statistics(random_domain((50, 40), n, n), 1.0)["cluster_octaves"])
        for n in (0, 1, 100, 2000)
    }
    assert lengths == {11}


def test_windows_smaller_than_the_quadrats():
    for shape in ((1, 1), (1, 9), (5, 3), (9, 7)):
        found = cluster_statistics(np.ones(shape, bool), 1.0)
        assert found["clusters"] == 1
        contact, cells = quadrat_counts(np.ones(shape, bool))
        np.testing.assert_array_equal(contact, cells)
        assert cells.min() >= 1
