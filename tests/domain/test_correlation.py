import numpy as np
import pytest
from ensembles import ensemble
from known_sets import percolation_cluster, sierpinski_carpet

from fractalcontact.domain.correlation import correlation_dimension, pair_counts


def test_filled_window_is_plane():
    assert correlation_dimension(np.ones((100, 140), dtype=bool), 0.1).value == pytest.approx(2)


def test_carpet():
    exact = np.log(8) / np.log(3)
    found = correlation_dimension(sierpinski_carpet(729), 0.1)
    assert found.value == pytest.approx(exact, abs=0.02)
    assert found.low <= exact <= found.high


def test_percolation_cluster():
    exact = 91 / 48
    n, seeds = ensemble("pair percolation clusters")
    found = [correlation_dimension(percolation_cluster(n, seed), 0.1) for seed in range(seeds)]
    assert np.mean([f.value for f in found]) == pytest.approx(exact, abs=0.02)
    assert np.mean([f.low <= exact <= f.high for f in found]) >= 0.8


def test_pairs_agree_with_distances():
    domain = np.random.default_rng(0).random((20, 26)) < 0.2
    nodes = np.argwhere(domain)
    distance = np.hypot(*(nodes[:, np.newaxis] - nodes).transpose(2, 0, 1))
    wanted = np.array([1.0, 2.5, np.sqrt(13), 6.0])
    pairs, lags = pair_counts(domain, wanted)
    expected = [np.sum((distance > 0) & (distance <= r + 1e-9)) for r in wanted]
    np.testing.assert_allclose(pairs[:, 1].sum(axis=1), expected)
    assert (pairs[:, 0].sum(axis=1) >= pairs[:, 1].sum(axis=1)).all()
    assert lags[0] == 4  # the four neighbours


def test_no_pairs_no_dimension():
    point = np.zeros((64, 64), dtype=bool)
    assert correlation_dimension(point, 1.0).n == 0
    point[3, 5] = True
    assert correlation_dimension(point, 1.0).n == 0
    assert correlation_dimension(np.ones((6, 6), dtype=bool), 1.0).n == 0
