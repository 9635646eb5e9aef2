"""The operator that sums pairs of nodes is the convolution, to rounding."""

import numpy as np
import pytest

from roughcontact import HalfSpace
from roughcontact.elastic.direct import MAX_PAIRS, DirectOperator


@pytest.mark.parametrize("dtype", list(MAX_PAIRS))
@pytest.mark.parametrize("spacing", [(1.0, 1.0), (1.25, 1.0), (0.1, 0.125)])
@pytest.mark.parametrize("shape", [(1, 1), (8, 8), (1, 300), (97, 260), (301, 90)])
@pytest.mark.parametrize("kernel", ["love", "equal-area disc"])
def test_random_sets(kernel, shape, spacing, dtype):
    if kernel != "love":
        spacing = 0.3
    rng = np.random.default_rng(shape[0])
    space = HalfSpace(shape, spacing, 1.0, kernel=kernel)
    total = shape[0] * shape[1]
    nodes = np.sort(rng.choice(total, -(-total // 20), replace=False)).astype(np.int32)
    # In any order, as directions on two sets come one after the other.
    positions = rng.choice(nodes.size, -(-nodes.size // 3), replace=False)
    values = rng.standard_normal(positions.size).astype(dtype)
    window = np.zeros(shape)
    window.ravel()[nodes[positions]] = values
    exact = space.convolve(window).ravel()[nodes]
    found = DirectOperator(space, nodes)(positions, values)
    assert found.dtype == dtype
    allowed = 2e-6 if dtype == np.float32 else 1e-12
    assert np.abs(found - exact).max() <= allowed * np.abs(exact).max()


def test_each_influence():
    """One loaded node: what is looked up and what is evaluated are the table of the influence."""
    space = HalfSpace((200, 200), (1.0, 1.2), 1.0)
    nodes = np.arange(0, 40000, 7, dtype=np.int32)
    operator, everywhere = DirectOperator(space, nodes), np.array(np.divmod(nodes, 200))
    for loaded in (0, 1234, nodes.size - 1):
        found = operator(np.array([loaded]), np.ones(1))
        y, x = np.abs(everywhere - everywhere[:, [loaded]])
        np.testing.assert_allclose(found, space.influence()[y, x], rtol=2e-12)
