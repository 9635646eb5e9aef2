"""Bounds of the pressure: the same on all nodes or on each its own, and on coarser grids."""

import numpy as np
import pytest

from roughcontact.contact.bounds import Bounds

SHAPE = (6, 8)
UNIFORM = Bounds(0.5, 3.0)
ON_NODES = Bounds(np.full(48, 0.5), np.full(48, 3.0))
PRESSURE = np.array([0.5, 1.0, 3.0, 2.0, 0.25, 3.5])


def test_bounds_of_each_node_are_coarsened_as_those_that_are_the_same_everywhere():
    uniform, on_nodes = UNIFORM.coarser(SHAPE), ON_NODES.coarser(SHAPE)
    assert (uniform.lower, uniform.upper) == (1.0, 6.0)
    np.testing.assert_allclose(on_nodes.lower, np.full(12, 1.0))
    np.testing.assert_allclose(on_nodes.upper, np.full(12, 6.0))


@pytest.mark.parametrize("bounds", [UNIFORM, ON_NODES.at(np.arange(6))])
def test_a_pressure_is_between_its_bounds_at_them_or_beyond(bounds):
    np.testing.assert_array_equal(bounds.between(PRESSURE), [1, 3])
    np.testing.assert_array_equal(bounds.clip(PRESSURE), [0.5, 1, 3, 2, 0.5, 3])
    assert bounds.violation(PRESSURE) == 0.5
    assert bounds.violation(np.full(6, 0.1)) == pytest.approx(0.4)
    assert bounds.violation(np.full(6, 3.7)) == pytest.approx(0.7)


@pytest.mark.parametrize("bounds", [UNIFORM, ON_NODES.at(np.arange(6))])
def test_an_upper_bound_is_reached_at_it_and_within_rounding(bounds):
    assert bounds.reached_by(PRESSURE)
    below = np.full(6, 2.999)
    assert not bounds.reached_by(below)
    assert bounds.reached_by(below, rounding=1e-3)
    assert not bounds.reached_by(below, rounding=1e-4)
    assert bounds.over(2.0).reached_by(np.full(6, 1.5))
