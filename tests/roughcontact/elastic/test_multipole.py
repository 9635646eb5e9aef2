"""The multipole operator between the nodes of a set is the convolution, to its stated error."""

import numpy as np
import pytest

from roughcontact import HalfSpace
from roughcontact.elastic import multipole
from roughcontact.elastic.block_influence import ERROR
from roughcontact.elastic.block_pairs import MultipoleLevels
from roughcontact.elastic.multipole import MAX_STRETCHED, MultipoleOperator, multipole_suits

#: Rounding in single precision of sums of thousands of terms, as a fraction of the largest.
ROUNDING = {np.float32: 1e-5, np.float64: 1e-13}


def apply(space, nodes, positions, values):
    levels = MultipoleLevels(space.shape, nodes)
    return MultipoleOperator(space, levels, values.dtype.type)(positions, values)


def error(space, nodes, positions, values):
    """Largest error over the largest displacement."""
    window = np.zeros(space.shape)
    window.ravel()[nodes[positions]] = values
    exact = space.convolve(window).ravel()[nodes]
    found = apply(space, nodes, positions, values)
    assert found.dtype == values.dtype
    return np.abs(found - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize("few", [0, 64])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("kernel", ["love", "equal-area disc"])
@pytest.mark.parametrize(
    "shape", [(1, 1), (8, 8), (49, 50), (1, 300), (97, 260), (256, 256), (500, 333)]
)
def test_random_sets(monkeypatch, shape, kernel, dtype, few):
    # Loaded cells of a smallest block all together, and one by one.
    monkeypatch.setattr(multipole, "FEW", few)
    rng = np.random.default_rng(shape[0])
    space = HalfSpace(shape, (0.1, 0.1), 1.0, kernel=kernel)
    total = shape[0] * shape[1]
    nodes = np.sort(rng.choice(total, -(-total // 9), replace=False)).astype(np.int32)
    positions = np.sort(rng.choice(nodes.size, -(-nodes.size // 3), replace=False))
    values = rng.standard_normal(positions.size).astype(dtype)
    allowed = ERROR[np.dtype(dtype)] + ROUNDING[dtype]
    assert error(space, nodes, positions, values) < allowed


@pytest.mark.parametrize("spacing", [(1.0, 1.0), (1.0, MAX_STRETCHED), (MAX_STRETCHED, 1.0)])
def test_each_influence(spacing):
    """One loaded node and one displaced: nothing averages the error of the interpolation."""
    n = 320
    space = HalfSpace((n, n), spacing, 1.0)
    rng = np.random.default_rng(0)
    nodes = np.sort(rng.choice(n * n, 4000, replace=False)).astype(np.int32)
    worst = 0.0
    for loaded in rng.choice(4000, 20, replace=False):
        values = np.ones(1)
        found = apply(space, nodes, np.array([loaded]), values)
        y, x = np.abs(np.array(np.divmod(nodes, n)) - np.array(divmod(nodes[loaded], n))[:, None])
        exact = space.influence()[y, x]
        worst = max(worst, np.abs(found / exact - 1).max())
    assert 1e-14 < worst < 10 * ERROR[np.dtype(np.float64)]


def test_symmetry():
    space = HalfSpace((200, 200), (1.0, 1.0), 1.0)
    rng = np.random.default_rng(0)
    nodes = np.sort(rng.choice(40000, 2000, replace=False)).astype(np.int32)
    everywhere = np.arange(nodes.size)
    p, q = rng.random((2, nodes.size))
    there, back = (apply(space, nodes, everywhere, values) for values in (p, q))
    assert q @ there == pytest.approx(p @ back, rel=1e-11)


def test_threads_change_no_bit(monkeypatch):
    space = HalfSpace((300, 300), (1.0, 1.0), 1.0)
    nodes = np.arange(0, 90000, 5, dtype=np.int32)
    values = np.random.default_rng(0).random(nodes.size).astype(np.float32)
    images = []
    for count in "12":
        monkeypatch.setenv("OMP_NUM_THREADS", count)
        images.append(apply(space, nodes, np.arange(nodes.size), values))
    np.testing.assert_array_equal(*images)


def test_suits_nearly_square_cells():
    assert multipole_suits(HalfSpace((9, 9), (1.0, 1.2), 1.0))
    assert not multipole_suits(HalfSpace((9, 9), (1.0, 1.3), 1.0))
