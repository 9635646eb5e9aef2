import numpy as np
import pytest

from fractalcontact.core.slope_of_sums import BLOCKS
from fractalcontact.domain.multifractal import (
    ORDERS,
    generalised_dimensions,
    gliding_moments,
    lacunarity,
)

WEIGHTS = np.array([0.4, 0.3, 0.2, 0.1])


def cascade(levels=9):
    """Mass that is shared out among quarters with the same weights again and again."""
    mass = np.ones((1, 1))
    for _ in range(levels):
        mass = np.kron(mass, WEIGHTS.reshape(2, 2))
    return mass


def exact(q):
    if q == 1:
        return -np.sum(WEIGHTS * np.log2(WEIGHTS))
    return np.log2(np.sum(WEIGHTS**q)) / (1 - q)


# -- exact -----------------------------------------------------------------------------------------


def test_even_pressure_is_plane_at_every_order():
    for slope in generalised_dimensions(np.full((100, 130), 3.0), 0.1).values():
        assert slope.value == pytest.approx(2)
        assert slope.high - slope.low < 1e-9


def test_spectrum_of_a_cascade():
    found = generalised_dimensions(cascade(), 0.1)
    assert list(found) == list(ORDERS)
    for q, slope in found.items():
        assert slope.value == pytest.approx(exact(q), abs=0.03)
        assert slope.low <= exact(q) <= slope.high


def test_lacunarity_of_an_even_window_is_one():
    found = lacunarity(np.ones((40, 50), dtype=bool), 0.1)
    np.testing.assert_allclose(found.value, 1)


def test_lacunarity_of_independent_nodes():
    # <M^2>/<M>^2 = 1 + (1 - p) / (p r^2) for M of a binomial distribution.
    domain = np.random.default_rng(0).random((512, 512)) < 0.2
    found = lacunarity(domain, 1.0)
    small = found.r <= 16
    expected = 1 + 4 / found.r[small] ** 2
    np.testing.assert_allclose(found.value[small], expected, rtol=0.02)
    assert ((found.low <= expected[0] * 1.02) | ~small).all()


# -- independent -----------------------------------------------------------------------------------


@pytest.mark.parametrize("orders", [[-1.0, 0.0, 1.0, 2.0, 2.5], ORDERS, [0.0, 100.0], []])
def test_moments_agree_with_summing_by_hand(orders):
    mass = np.random.default_rng(0).random((13, 17)) * (
        np.random.default_rng(1).random((13, 17)) < 0.3
    )
    moments, places = gliding_moments(mass, [1, 4], orders)
    assert moments.shape == (2, len(orders) + 1, BLOCKS**2)
    for k, r in enumerate((1, 4)):
        windows = np.lib.stride_tricks.sliding_window_view(mass / mass.sum(), (r, r))
        p = windows.sum(axis=(2, 3)).ravel()
        assert places[k].sum() == p.size
        p = p[p > 0]
        expected = [np.sum(p**q) for q in orders] + [np.sum(p * np.log(p))]
        np.testing.assert_allclose(moments[k].sum(axis=1), expected)


# -- properties ------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [2, 4, 10])
def test_parts_of_a_mass_turn_with_it(size):
    """A box belongs to the part that holds its middle."""
    mass = np.random.default_rng(3).random((29, 43)) ** 4  # odd: no middle between two parts
    moments, places = (found.reshape(-1, BLOCKS, BLOCKS) for found in parts_of(mass, size))
    for turned, axes in ((mass[::-1], 1), (mass[:, ::-1], 2)):
        other, there = (found.reshape(-1, BLOCKS, BLOCKS) for found in parts_of(turned, size))
        np.testing.assert_array_equal(np.flip(there, axes), places)
        np.testing.assert_allclose(np.flip(other, axes), moments, rtol=1e-12)
    other, there = (found.reshape(-1, BLOCKS, BLOCKS) for found in parts_of(mass.T, size))
    np.testing.assert_array_equal(there.swapaxes(1, 2), places)
    np.testing.assert_allclose(other.swapaxes(1, 2), moments, rtol=1e-12)


def parts_of(mass, size):
    """Moments and places of boxes of one size, by part of the window."""
    moments, places = gliding_moments(mass, [size], [-1.0, 0.0, 2.0])
    return moments[0], places[0]


def test_unit_of_pressure_does_not_matter():
    mass = cascade(7)
    pascal = generalised_dimensions(1e6 * mass, 0.1)
    for q, slope in generalised_dimensions(mass, 0.1).items():
        assert pascal[q].value == pytest.approx(slope.value)
        assert slope.over[1] <= 0.1 * 128 / 4 + 1e-9


def test_no_contact_has_no_measures():
    empty = np.zeros((64, 64))
    assert all(np.isnan(slope.value) for slope in generalised_dimensions(empty, 1.0).values())
    assert np.isnan(lacunarity(empty, 1.0).value).all()


def test_few_nodes_have_no_generalised_dimension():
    # Boxes within the window meet a corner less often: it would have 1.8.
    for row, column in ((1, 1), (100, 100), (3, 170)):
        mass = np.zeros((200, 200))
        mass[row, column] = 1.0
        assert all(np.isnan(slope.value) for slope in generalised_dimensions(mass, 0.1).values())


def test_bad_masses_are_refused():
    with pytest.raises(ValueError, match="negative"):
        gliding_moments(np.full((4, 4), -1.0), [1], [2.0])
    with pytest.raises(ValueError, match="grid"):
        gliding_moments(np.ones(4), [1], [2.0])
