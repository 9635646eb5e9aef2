"""Cheaper models: exact where they should be, and between the bounds they must respect."""

import numpy as np
import pytest

from contactlab.accuracy.cheap_models import bearing_area, coarse_grid, foundation_modulus, winkler
from contactlab.accuracy.reference import hertz_problem
from fractalcontact import HalfSpace, solve_contact
from fractalcontact.surface.synthesis import self_affine

SIDE = 2.0  # mm
E_STAR = 1e4  # MPa


@pytest.fixture
def space():
    return HalfSpace((40, 60), (SIDE / 40, 3.0 / 60), E_STAR)


@pytest.fixture
def slope(space):
    """A plane that falls by 1 mm along x: the bearing area is the closure as a share of it."""
    ny, nx = space.shape
    return np.tile(-(np.arange(nx) + 0.5) / nx, (ny, 1))


@pytest.fixture
def rough():
    return self_affine((64, 64), 1 / 64, 0.8, rms=0.02, seed=3)


def test_bearing_area_of_a_slope_is_the_closure(space, slope):
    cut = bearing_area(slope, space, closure=0.25)
    assert cut.area == pytest.approx(0.25 * SIDE * 3.0)
    assert np.isnan(cut.force)
    assert np.isnan(cut.pressure[cut.in_contact]).all()


def test_winkler_settles_a_flat_block_as_the_half_space_does_in_the_mean(space):
    flat = np.zeros(space.shape)
    pressed = winkler(flat, space, closure=0.01)
    load = np.full(space.shape, pressed.pressure[0, 0])
    assert np.ptp(pressed.pressure) == 0
    assert space.displacement(load).mean() == pytest.approx(0.01, rel=2e-3)


def test_winkler_is_exact_on_a_slope(space, slope):
    """F = k w^2 / (2 slope) per width, but for the cells: their mid-points make it exact."""
    pressed = winkler(slope, space, closure=0.25 + 0.5 / 60)
    depth = 0.25 + 0.5 / 60 - (np.arange(60) / 60)
    exact = foundation_modulus(space) * depth.clip(0).sum() * SIDE * (3.0 / 60)
    assert pressed.force == pytest.approx(exact)


def test_rigid_cut_holds_the_elastic_contact(rough):
    """u >= 0: what touches lies above the plane."""
    space = HalfSpace(rough.shape, (1 / 64, 1 / 64), 1.0)
    cut = bearing_area(rough, space, closure=0.03)
    state = solve_contact(rough, space, closure=0.03)
    assert not (state.in_contact & ~cut.in_contact).any()


def test_coarse_grid_comes_closer_to_hertz_than_its_own_grid():
    problem = hertz_problem(128)
    exact = problem.single.state
    found = coarse_grid(problem.height, problem.space, closure=problem.closure)
    sample = problem.height[::2, ::2]
    left = problem.closure - (problem.height.max() - sample.max())
    coarse = solve_contact(sample, problem.space.coarser(2), closure=left)
    assert abs(found.force / exact.force - 1) < abs(coarse.force / exact.force - 1) < 0.01
    assert found.area == pytest.approx(exact.area, rel=0.02)


def test_coarse_grid_that_misses_the_peak_has_no_force():
    height = np.full((16, 16), -1.0)
    height[5, 7] = 0.0
    found = coarse_grid(height, HalfSpace((16, 16), (0.1, 0.1), 1.0), closure=0.01)
    assert np.isnan(found.force)
    assert np.isnan(found.area)
