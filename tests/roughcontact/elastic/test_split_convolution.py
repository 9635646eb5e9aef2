"""The split convolution is the zero-padded one, to its stated error."""

import numpy as np
import pytest

from roughcontact import HalfSpace, threads
from roughcontact.elastic import halfspace
from roughcontact.elastic.influence import influence_table
from roughcontact.elastic.split_convolution import MIN_SPLIT_SIDE, SplitConvolution

#: Largest error over the largest displacement, of random pressures of either sign.
ERROR = 4e-6


def error(space, values):
    exact = space.convolve(values.astype(float))
    split = SplitConvolution(space.shape, space._sides, space._self_term)
    found = split(values.astype(np.float32))
    assert found.dtype == np.float32
    return np.abs(found - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize("kernel", ["love", "equal-area disc"])
@pytest.mark.parametrize("shape", [(1, 1), (7, 300), (64, 64), (129, 203), (301, 40)])
def test_any_window(shape, kernel):
    rng = np.random.default_rng(shape[0])
    space = HalfSpace(shape, 0.1, 1.0, kernel=kernel)
    values = rng.standard_normal(shape) * (rng.random(shape) < 0.3)
    values[0, 0] = 1.0
    assert error(space, values) < ERROR
    assert error(space, np.abs(values)) < ERROR


@pytest.mark.parametrize("ratio", [1.0, halfspace.MAX_STRETCHED, 1 / halfspace.MAX_STRETCHED])
def test_stretched_cells(ratio):
    rng = np.random.default_rng(3)
    space = HalfSpace((150, 210), (0.1, 0.1 * ratio), 1.0)
    assert error(space, rng.standard_normal(space.shape)) < ERROR


def test_one_node_acts_on_every_other_by_the_influence():
    """At every distance up to that of opposite corners, of the influence there."""
    space = HalfSpace((330, 300), 1.0, 1.0)
    values = np.zeros(space.shape)
    values[0, 0] = 1.0
    split = SplitConvolution(space.shape, space._sides, None)
    exact = influence_table(space.shape, space._sides, None)
    np.testing.assert_allclose(split(values.astype(np.float32)), exact, rtol=2e-4, atol=1e-6)


def test_symmetric():
    rng = np.random.default_rng(5)
    space = HalfSpace((200, 130), 1.0, 1.0)
    split = SplitConvolution(space.shape, space._sides, None)
    one, two = rng.standard_normal((2, *space.shape)).astype(np.float32)
    scale = np.linalg.norm(one) * np.linalg.norm(split(two))
    assert abs(np.vdot(one, split(two)) - np.vdot(two, split(one))) < 1e-6 * scale


def test_used_in_single_precision_on_large_windows_of_nearly_square_cells():
    large = (MIN_SPLIT_SIDE, MIN_SPLIT_SIDE + 10)
    assert isinstance(HalfSpace(large, 1.0, 1.0)._single, SplitConvolution)
    assert not isinstance(HalfSpace(large, (1.0, 2.1), 1.0)._single, SplitConvolution)
    assert not isinstance(HalfSpace((MIN_SPLIT_SIDE - 1, 900), 1.0, 1.0)._single, SplitConvolution)
    rng = np.random.default_rng(7)
    space = HalfSpace(large, 1.0, 1.0)
    values = rng.random(large) * (rng.random(large) < 0.1)
    exact = space.convolve(values)
    found = space.convolve(values.astype(np.float32))
    assert np.abs(found - exact).max() < ERROR * exact.max()


def test_the_same_to_the_last_bit_on_any_number_of_threads(monkeypatch):
    rng = np.random.default_rng(9)
    values = rng.standard_normal((500, 420)).astype(np.float32)
    split = SplitConvolution(values.shape, (1.0, 1.0), None)
    found = []
    for number in (1, 2, 3):
        monkeypatch.setattr(threads, "count", lambda number=number: number)
        found.append(split(values))
    np.testing.assert_array_equal(found[0], found[1])
    np.testing.assert_array_equal(found[0], found[2])


def test_refuses_other_fields():
    split = SplitConvolution((30, 40), (1.0, 1.0), None)
    for values in (np.zeros((40, 30), np.float32), np.zeros((30, 40))):
        with pytest.raises(ValueError, match="field"):
            split(values)
