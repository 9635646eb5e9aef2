"""The operator of periodic and mirrored windows."""

import pickle

import numpy as np
import pytest
from repeated_windows import dense_operator, displacement, reflected

from roughcontact import HalfSpace

BOUNDARIES = ["periodic", "mirrored"]
#: Fast lengths, primes, strips, and windows of one node or row.
SHAPES = [(8, 12), (7, 9), (97, 30), (1, 5), (6, 1), (2, 2), (1, 1), (64, 80)]


@pytest.fixture
def rng():
    return np.random.default_rng(5)


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("spacing", [0.1, (0.3, 0.02)])
@pytest.mark.parametrize("shape", SHAPES)
def test_displacement_is_that_of_each_wave_number(shape, spacing, boundary, rng):
    space = HalfSpace(shape, spacing, 3e3, boundary=boundary)
    pressure = rng.random(shape)
    expected = displacement(pressure, space)
    scale = np.abs(expected).max() + space.cell / space.modulus
    found = space.displacement(pressure)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * scale)
    assert abs(found.mean()) <= 1e-14 * scale
    single = space.convolve(pressure.astype(np.float32)) * (space.cell / space.modulus)
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, expected, rtol=0, atol=1e-5 * scale)


@pytest.mark.parametrize("shape", [(512, 500), (400, 401)])
@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_large_windows_are_transformed_in_threads(shape, boundary, rng):
    space = HalfSpace(shape, 0.1, 3e3, boundary=boundary)
    pressure = rng.random(shape)
    expected = displacement(pressure, space)
    np.testing.assert_allclose(
        space.displacement(pressure), expected, rtol=0, atol=1e-12 * np.abs(expected).max()
    )


@pytest.mark.parametrize("shape", [(8, 12), (7, 9), (1, 5)])
def test_mirrored_is_periodic_on_the_reflected_window(shape, rng):
    spacing, pressure = (0.1, 0.15), rng.random(shape)
    twice = HalfSpace((2 * shape[0], 2 * shape[1]), spacing, 3e3, boundary="periodic")
    expected = twice.displacement(reflected(pressure))[: shape[0], : shape[1]]
    found = HalfSpace(shape, spacing, 3e3, boundary="mirrored").displacement(pressure)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14 * np.abs(expected).max() * 10)


@pytest.mark.parametrize("shape", [(8, 12), (7, 9), (5, 8)])
@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_operator_is_symmetric_and_positive_but_for_constants(shape, boundary):
    space = HalfSpace(shape, (0.1, 0.13), 1.0, boundary=boundary)
    matrix = _matrix(space)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-15)
    values = np.linalg.eigvalsh(matrix)
    assert abs(values[0]) < 1e-14
    assert values[1] > 0.01 * values[-1]
    np.testing.assert_allclose(matrix, dense_operator(space), atol=1e-15)


def _matrix(space):
    loads = np.eye(space.shape[0] * space.shape[1]).reshape(-1, *space.shape)
    return np.stack([space.displacement(load).ravel() for load in loads], axis=1)


@pytest.mark.parametrize("shape", [(8, 12), (7, 9), (7, 12), (1, 1)])
def test_influence_of_a_periodic_node(shape):
    space = HalfSpace(shape, (0.1, 0.13), 2.0, boundary="periodic")
    load = np.zeros(shape)
    load[0, 0] = 1.0
    np.testing.assert_allclose(space.influence(), space.convolve(load), atol=1e-15)
    # Further than the window it repeats itself.
    around = space.influence_within((2 * shape[0], 2 * shape[1]))
    np.testing.assert_allclose(around, np.tile(space.influence(), (2, 2)), atol=1e-15)


def test_influence_of_a_mirrored_node_has_no_reflections():
    mirrored = HalfSpace((6, 7), 0.1, 1.0, boundary="mirrored")
    twice = HalfSpace((12, 14), 0.1, 1.0, boundary="periodic")
    np.testing.assert_allclose(mirrored.influence(), twice.influence()[:6, :7], atol=1e-15)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_coarser_windows_have_the_boundary_too(boundary):
    coarse = HalfSpace((9, 8), 0.1, 1.0, boundary=boundary).coarser(2)
    assert coarse == HalfSpace((5, 4), 0.2, 1.0, boundary=boundary)
    assert coarse.convolve(np.ones((5, 4), np.float32)) == pytest.approx(0, abs=1e-6)


def test_boundary_is_part_of_what_a_half_space_is():
    free, periodic = HalfSpace((4, 4), 0.1, 1.0), HalfSpace((4, 4), 0.1, 1.0, boundary="periodic")
    assert free.is_free
    assert free == HalfSpace((4, 4), 0.1, 1.0, boundary="free")
    assert not periodic.is_free
    assert free != periodic
    assert hash(free) != hash(periodic)
    assert eval(repr(periodic)) == periodic
    assert "boundary" not in repr(free)
    assert pickle.loads(pickle.dumps(periodic)) == periodic
    with pytest.raises(AttributeError, match="boundary of a HalfSpace cannot be changed"):
        periodic.boundary = "free"


@pytest.mark.parametrize("boundary", ["open", None, 1, ["free"]])
def test_other_boundaries_are_refused(boundary):
    with pytest.raises(ValueError, match="expected one of free, periodic, mirrored"):
        HalfSpace((4, 4), 0.1, 1.0, boundary=boundary)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_rigid_plate_kernels_are_those_of_a_free_window(boundary):
    with pytest.raises(ValueError, match=f"a free window, not {boundary}"):
        HalfSpace((4, 4), 0.1, 1.0, kernel="inscribed disc", boundary=boundary)


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("shape", [(6, 10), (7, 11)])
def test_fields_of_another_grid_are_refused(shape, boundary):
    space = HalfSpace(shape, 0.1, 1.0, boundary=boundary)
    with pytest.raises(ValueError, match="expected"):
        space.convolve(np.zeros((shape[0], shape[1] + 1)))
    with pytest.raises(ValueError, match="expected"):
        space.convolve(np.zeros(shape, np.int64))
