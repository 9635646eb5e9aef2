"""Equations on a contact set: solved to their goal, with the sum kept where it is given."""

import numpy as np
import pytest

from roughcontact import HalfSpace
from roughcontact.contact.bounds import Bounds
from roughcontact.contact.operator import Operator
from roughcontact.contact.projected_cg import ProjectedCG

GOAL = 1e-4


def clipped_equations(share, by_force, seed=1):
    """Equations on a third of a window after a step that took a share of the set to zero."""
    rng = np.random.default_rng(seed)
    space = HalfSpace((200, 190), 1.0, 1.0)
    total = space.shape[0] * space.shape[1]
    active = np.sort(rng.choice(total, total // 3, replace=False)).astype(np.int32)
    operator = Operator(space)
    operator.precondition(active, fresh=True)
    right = rng.standard_normal(active.size)
    right /= np.abs(right).max()
    equations = ProjectedCG(operator, active, right)
    start = np.quantile(np.abs(operator.inverse(right.astype(np.float32))), 1 - share)
    start = np.full(active.size, start if share else 10 * start)
    given = start.sum() if by_force else None
    equations.clipped_step(start, Bounds(), given)
    nothing = np.empty(0, np.int32), np.empty(0, np.float32)
    equations.apply_step(*nothing)
    return operator, equations, right, start


@pytest.mark.parametrize("by_force", [False, True])
@pytest.mark.parametrize("share", [0.0, 0.004, 0.2])
def test_residuals_reach_the_goal_on_the_nodes_not_clipped(share, by_force):
    operator, equations, right, start = clipped_equations(share, by_force)
    unclipped = equations.unclipped > 0
    assert (np.count_nonzero(~unclipped) > 0) == (share > 0)
    moved = equations.solution.copy()
    before = operator.applications
    equations.iterate(GOAL, by_force=by_force)
    assert operator.applications - before < 20
    np.testing.assert_array_equal(equations.solution[~unclipped], moved[~unclipped])
    pressure = np.zeros(operator.size)
    pressure[equations.active] = equations.solution
    image = operator(pressure)[equations.active]
    residual = right + equations.multiplier - image
    assert np.abs(residual[unclipped]).max() < 1.5 * GOAL
    if by_force:
        total = (start + equations.solution).sum()
        assert total == pytest.approx(start.sum(), rel=1e-5)
    else:
        assert equations.multiplier == 0


def test_a_set_that_is_solved_already_takes_no_application():
    operator, equations, _, _ = clipped_equations(0.0, True)
    equations.iterate(GOAL, by_force=True)
    before, multiplier = operator.applications, equations.multiplier
    equations.iterate(2 * GOAL, by_force=True)
    assert operator.applications == before
    assert equations.multiplier == pytest.approx(multiplier, abs=3 * GOAL)
