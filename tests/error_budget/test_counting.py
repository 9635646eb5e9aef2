"""Counted errors: what the stiffness owes to the amplitude of the waves."""

import numpy as np
import pytest

from fractalcontact import HalfSpace, solve_contact
from fractalcontact.error_budget.counting import _steepness
from fractalcontact.surface.synthesis import self_affine


def test_stiffness_of_scaled_heights_is_that_under_as_much_less_force():
    heights = self_affine((48, 48), 0.1, 0.8, rms=0.1, seed=2)
    space = HalfSpace(heights.shape, (0.1, 0.1), 1e4)
    scaled = solve_contact(1.25 * heights, space, force=1000.0, rtol=1e-6)
    lighter = solve_contact(heights, space, force=800.0, rtol=1e-6)
    assert scaled.stiffness == pytest.approx(lighter.stiffness, rel=1e-3)
    assert scaled.in_contact.sum() == lighter.in_contact.sum()


def test_steepness_of_a_power_law_is_its_exponent_and_one_where_it_is_not_known():
    forces = np.array([1.0, 2.0, 5.0, 10.0])
    np.testing.assert_allclose(_steepness(forces, 3 * forces**1.3), 1.3)
    np.testing.assert_allclose(_steepness(forces[:1], np.array([3.0])), 1)
    np.testing.assert_allclose(_steepness(forces, np.full(4, np.nan)), 1)
