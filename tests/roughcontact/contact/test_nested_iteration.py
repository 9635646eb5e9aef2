"""From the pressure on a coarse grid to one on the grid twice as fine."""

import numpy as np
import pytest

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact.bounds import Bounds
from roughcontact.contact.kkt import Problem
from roughcontact.contact.nested_iteration import prolong
from roughcontact.contact.restriction import restrict_minimum, restrict_sum


def half_space(ny, nx, spacing=(0.1, 0.1)):
    return HalfSpace(shape=(ny, nx), spacing=spacing, modulus=1.0)


@pytest.mark.parametrize(
    ("restrict", "numpy_restrict"), [(restrict_minimum, np.nanmin), (restrict_sum, np.nansum)]
)
@pytest.mark.parametrize("shape", [(4, 6), (5, 7), (1, 2), (3, 1)])
def test_cells_of_two_by_two_nodes(shape, restrict, numpy_restrict):
    values = np.random.default_rng(1).standard_normal(shape)
    ny, nx = shape
    padded = np.pad(values, ((0, ny % 2), (0, nx % 2)), constant_values=np.nan)
    cells = padded.reshape((ny + 1) // 2, 2, (nx + 1) // 2, 2)
    np.testing.assert_allclose(restrict(values), numpy_restrict(cells, axis=(1, 3)), rtol=1e-14)


@pytest.mark.parametrize("by_force", [False, True])
def test_the_coarse_problem_is_that_of_the_same_pressures(by_force):
    """Twice their number displaces as much there; load and bounds are those of such pressures."""
    space = half_space(64, 80)
    y, x = np.indices(space.shape) / 80
    pressure = 1 + np.sin(3 * x) * np.cos(4 * y)
    load = pressure.sum() if by_force else 1.0
    fine = Problem(space, np.zeros(pressure.size), load, by_force, Bounds(0.0, pressure.max()))
    coarse = fine.coarser(np.zeros(pressure.size // 4))
    there = restrict_sum(pressure) / 2
    assert coarse.space.shape == there.shape == (32, 40)
    assert coarse.load == pytest.approx(there.sum() if by_force else 1.0)
    assert coarse.bounds.upper == 2 * fine.bounds.upper
    assert there.max() == pytest.approx(coarse.bounds.upper, rel=1e-2)
    of_nodes = Bounds(0.0, pressure.ravel()).coarser(space.shape)
    np.testing.assert_allclose(of_nodes.upper, there.ravel())
    mean = restrict_sum(space.convolve(pressure)) / 4
    np.testing.assert_allclose(coarse.space.convolve(there), mean, rtol=1e-2)


@pytest.mark.parametrize("shape", [(24, 30), (25, 31)])
def test_every_cell_keeps_its_mean(shape):
    rng = np.random.default_rng(5)
    ny, nx = shape
    coarse = rng.random(((ny + 1) // 2, (nx + 1) // 2))
    coarse *= rng.random(coarse.shape) > 0.3
    fine = prolong(coarse, rng.random(shape), half_space(ny, nx).influence())
    padded = np.pad(fine, ((0, ny % 2), (0, nx % 2)), constant_values=np.nan)
    cells = padded.reshape(coarse.shape[0], 2, -1, 2)
    np.testing.assert_allclose(np.nanmean(cells, axis=(1, 3)), coarse, atol=1e-12)
    assert (fine >= 0).all()
    # Heights differ by more than the pressures can even out: some nodes are left without.
    assert (fine[:, 1::2] == 0).any()


@pytest.mark.parametrize("spacing", [(0.1, 0.1), (0.05, 0.2)])
@pytest.mark.parametrize("depth", [0.0, 0.3, 3.0])
def test_one_cell_alone_is_solved_exactly(spacing, depth):
    """Nothing else touches, so what is shared among four nodes is the solution."""
    space = half_space(24, 26, spacing)
    clearance = np.full(space.shape, 1e6)
    clearance[10:12, 12:14] = depth * np.array([[0.0, 0.1], [0.2, 0.3]])
    coarse = np.zeros((12, 13))
    coarse[5, 6] = 0.25
    # Unit pressure displaces by the influence in units of modulus and cell.
    unit = space.cell / space.modulus
    fine = prolong(coarse, clearance, space.influence())
    state = solve_contact(-clearance * unit, space, force=space.cell_area, rtol=1e-12)
    np.testing.assert_allclose(fine, state.pressure, atol=1e-6)
    assert np.count_nonzero(fine) == {0.0: 4, 0.3: 4, 3.0: 2}[depth]


def test_neighbours_take_load_off_the_edge_they_share():
    """Two loaded cells side by side: a lower pressure between them than at their outer ends."""
    coarse = np.zeros((12, 12))
    coarse[6, 5:7] = 1.0
    fine = prolong(coarse, np.zeros((24, 24)), half_space(24, 24).influence())
    assert (fine[12:14, 13] < fine[12:14, 10]).all()


def test_where_one_node_of_a_cell_can_touch_it_carries_all():
    """Whatever its gap. On cells of this shape, W W / W is not W for rounding."""
    clearance = np.full((24, 26), 1e30)
    clearance[10, 12] = 1e20
    coarse = np.zeros((12, 13))
    coarse[5, 6] = 0.25
    fine = prolong(coarse, clearance, half_space(24, 26, (0.1, 0.155)).influence())
    assert fine[10, 12] == 4 * 0.25
    assert np.count_nonzero(fine) == 1
