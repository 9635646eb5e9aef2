"""Slope of the closure curve where nodes yield: exact on a sphere, the same on every grid."""

import numpy as np
import pytest
from rough_surfaces import self_affine

from roughcontact.contact.path import load_path
from roughcontact.contact.slope import ALL_YIELDED, FEW_CELLS, SECANT_RTOL, secant_slope
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.limits import RESOLVED_NODES

E_STAR, SPACING = 1e4, 0.05


def rough(n, seed):
    """A face of sandstone-like statistics, and its half-space."""
    space = HalfSpace((n, n), SPACING, E_STAR)
    return self_affine((n, n), SPACING, 0.8, rms=0.3, seed=seed, roll_off=2.5), space


@pytest.mark.parametrize("n", [129, 257])
def test_slope_of_a_sphere_far_beyond_its_elastic_limit(n):
    """From F = pi a^2 H and w = a^2 / 2R + 4 H a / (pi E*)."""
    radius, hardness, a = 1000.0, 20.0, 25.0
    x = (np.arange(n) - n // 2) * (2.4 * a / n)
    height = -(x[:, None] ** 2 + x**2) / (2 * radius)
    space = HalfSpace((n, n), 2.4 * a / n, E_STAR)
    state = solve_contact(height, space, force=np.pi * a**2 * hardness, hardness=hardness)
    exact = 2 * np.pi * a * hardness / (a / radius + 4 * hardness / (np.pi * E_STAR))
    assert state.slope.value == pytest.approx(exact, abs=state.slope.error)
    assert state.slope.error < 7 / n * exact


@pytest.mark.parametrize("pressure", [10.0, 25.0])
def test_slope_is_that_of_the_joint_and_not_of_the_grid(pressure):
    """Within its errors the same on every second node, and that of a wide span of closures."""
    hardness, every = 80.0, []
    fine, _ = rough(256, seed=1)
    for step in (1, 2):
        height = np.ascontiguousarray(fine[::step, ::step])
        space = HalfSpace(height.shape, SPACING * step, E_STAR)
        force = pressure * (256 * SPACING) ** 2
        state = solve_contact(height, space, force=force, hardness=hardness)
        low, high = (
            solve_contact(height, space, force=factor * force, hardness=hardness)
            for factor in (0.8, 1.25)
        )
        every.append(state.slope)
        steepest = (high.force - force) / (high.closure - state.closure)
        flattest = (force - low.force) / (state.closure - low.closure)
        error = 2 * state.slope.error
        assert min(flattest, steepest) - error < state.slope.value < max(flattest, steepest) + error
    first, second = every
    assert first.error < second.error < 0.2 * second.value
    assert abs(first.value - second.value) < 2 * np.hypot(first.error, second.error)


def test_both_ends_of_a_secant_are_near_the_state():
    """Also the lower one of a state under far more load than the one it was started from."""
    hardness, (height, space) = 80.0, rough(256, seed=1)
    light, heavy = (share * hardness * height.size * SPACING**2 for share in (0.6, 0.95))
    start = solve_contact(height, space, force=light, hardness=hardness)
    state = solve_contact(height, space, force=heavy, hardness=hardness, start=start)
    ends = []

    def counted(*args, **options):
        ends.append(solve_contact(*args, **options))
        return ends[-1]

    slope = secant_slope(state, counted)
    fewer, more = sorted(end.iterations for end in ends)
    assert more < 2 * fewer
    alone = [
        solve_contact(height, space, closure=end.closure, hardness=hardness, rtol=SECANT_RTOL)
        for end in ends
    ]
    exact = (alone[0].force - alone[1].force) / (ends[0].closure - ends[1].closure)
    assert slope.value == pytest.approx(exact, abs=slope.error - slope.scatter)


@pytest.mark.parametrize("seed", range(4))
def test_slope_is_never_negative_and_missing_with_its_reason(seed):
    """Where single cells carry the change of the force, or the whole window yields."""
    height, space = rough(64, seed)
    missing = 0
    for hardness in (20.0, 200.0, 2000.0):
        whole = hardness * space.cell_area * height.size
        for share in (0.1 / height.size, 3.5 / height.size, 0.02, 0.3, 0.9999):
            state = solve_contact(height, space, force=share * whole, hardness=hardness)
            slope = state.slope
            assert slope.value == pytest.approx(state.stiffness, nan_ok=True)
            if slope.reason:
                assert np.isnan([slope.value, slope.error]).all()
                assert slope.cells < RESOLVED_NODES
                assert slope.reason == (FEW_CELLS if slope.cells else ALL_YIELDED)
                missing += 1
            else:
                assert slope.value > 0
                assert 0 <= slope.scatter <= slope.value / np.sqrt(RESOLVED_NODES)
                assert slope.scatter < slope.error < slope.scatter + 1e-3 * slope.value
    assert missing


def test_slope_does_not_depend_on_units():
    height, space = rough(64, seed=5)
    state = solve_contact(height, space, force=500.0, hardness=200.0)
    metres = HalfSpace(space.shape, 1e-3 * SPACING, 1e6 * E_STAR)
    same = solve_contact(1e-3 * height, metres, force=500.0, hardness=200e6)
    assert 1e-3 * same.slope.value == pytest.approx(state.slope.value, rel=1e-3)
    assert same.slope.cells == pytest.approx(state.slope.cells, rel=1e-2)


def test_slope_of_an_elastic_branch_is_exact():
    """Also of unloading, whose heights are as they were pressed in."""
    height, space = rough(64, seed=6)
    path = load_path(height, space, forces=[500.0, 450.0, 449.0], hardness=200.0, rtol=1e-8)
    below = (path[1].force - path[2].force) / (path[1].closure - path[2].closure)
    assert path[1].contact.slope.value == pytest.approx(below, rel=0.01)
    assert path[1].contact.slope.cells == np.inf
    assert path[1].contact.stiffness > path[0].contact.stiffness


def test_slope_of_candidates_is_that_of_the_whole_window():
    height, space = rough(512, seed=7)
    state = solve_contact(height, space, force=200.0, hardness=200.0)
    assert hasattr(state, "candidates")
    whole = solve_contact(height, space, force=200.0, hardness=200.0, rtol=1e-9)
    assert not hasattr(whole, "candidates")
    assert state.slope.value == pytest.approx(whole.slope.value, rel=1e-3)
    np.testing.assert_allclose(np.ptp(state.composite), np.ptp(height))
