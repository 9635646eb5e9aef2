"""Contact of periodic and mirrored windows: exact solutions, dense programmes, hostile scenes.

``make problems PROBLEMS=300`` tries more of the last, up to 200 nodes per side.
"""

import os

import numpy as np
import pytest
from dense_programmes import dense_pressure
from random_problems import random_problem
from repeated_windows import dense_operator, displacement, reflected, violation
from rough_surfaces import self_affine

from roughcontact import HalfSpace, NotConverged, load_path, solve_contact
from roughcontact.contact.violation import violation as violation_of_free_windows

BOUNDARIES = ["periodic", "mirrored"]
SPACING, MODULUS = 0.1, 20e3
#: Random scenes of each boundary that are tried always.
ALWAYS = 40
SCENES = max(ALWAYS, int(os.environ.get("PROBLEMS", 0)))


def rough(boundary, n=64, seed=1, rms=0.1):
    """Heights in mm, half-space, and the force of a mean pressure of 1 MPa."""
    height = self_affine((n, n), SPACING, 0.8, rms=rms, seed=seed)
    return height, HalfSpace((n, n), SPACING, MODULUS, boundary=boundary), (n * SPACING) ** 2


def wave(boundary, n, amplitude=0.01, rows=1):
    """A sinusoid along x, its wave length, half-space, and its full-contact pressure.

    A mirrored window holds half a wave, with crest and trough on its edges.
    """
    waves = 1 if boundary == "periodic" else 0.5
    angle = 2 * np.pi * waves * (np.arange(n) + 0.5) / n
    height = np.broadcast_to(amplitude * np.cos(angle), (rows, n)).copy()
    space = HalfSpace((rows, n), SPACING, MODULUS, boundary=boundary)
    length = n * SPACING / waves
    return height, angle, space, np.pi * MODULUS * amplitude / length


# Exact solutions


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.3, 0.6, 0.9])
def test_sinusoid_in_partial_contact(ratio, boundary):
    """Westergaard (1939): mean pressure over that of full contact = sin^2(pi a / lambda)."""
    for n, most in ((128, 0.03), (512, 0.005)):
        height, angle, space, full = wave(boundary, n, rows=2)
        state = solve_contact(height, space, force=ratio * full * n * 2 * SPACING**2)
        half = np.arcsin(np.sqrt(ratio))  # pi a / lambda
        nodes = np.count_nonzero(state.in_contact[0])
        assert abs(nodes / n - 2 * half / np.pi) <= 2 / n
        psi = (angle + np.pi) % (2 * np.pi) / 2 - np.pi / 2
        inside = np.maximum(np.sin(half) ** 2 - np.sin(psi) ** 2, 0)
        exact = 2 * ratio * full * np.cos(psi) / np.sin(half) ** 2 * np.sqrt(inside)
        error = np.sqrt(np.mean((state.pressure - exact) ** 2) / np.mean(exact**2))
        assert error < most


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_sinusoid_in_full_contact(boundary):
    height, angle, space, full = wave(boundary, 60, rows=3)
    crest = height.max()
    for ratio in (1.0001, 2.0, 1e4):
        state = solve_contact(
            height, space, force=ratio * full * height.size * SPACING**2, rtol=1e-9
        )
        expected = full * (ratio + np.cos(angle))
        np.testing.assert_allclose(state.pressure[1], expected, atol=1e-7 * ratio * full)
        assert state.closure == pytest.approx(crest, abs=1e-6 * (crest + ratio * full / MODULUS))
        assert state.slope.value == np.inf


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_full_contact_has_the_spectrum_of_the_heights(boundary):
    """p(q) = E* q h(q) / 2, of a rough surface in full contact."""
    height, space, one = rough(boundary, n=30, rms=0.01)
    whole = reflected(height) if boundary == "mirrored" else height
    q = 2 * np.pi * np.hypot(*np.meshgrid(*[np.fft.fftfreq(len(whole), SPACING)] * 2))
    varying = np.fft.ifft2(np.fft.fft2(whole) * MODULUS * q / 2).real[:30, :30]
    mean = 1.05 * -varying.min()
    state = solve_contact(height, space, force=mean * one, rtol=1e-9)
    np.testing.assert_allclose(state.pressure, mean + varying, atol=1e-7 * mean)
    assert state.closure == pytest.approx(height.max() - height.mean(), rel=1e-8)


def test_sphere_in_a_cell_much_larger_than_its_contact():
    """Hertz; and the mean plane lies 3.900265 F / (pi E* L) above what is far from the sphere.

    The number is the potential of a square lattice of charges in an even background (the Madelung
    constant of the Wigner crystal in the plane, for charges a unit apart).
    """
    n, radius = 256, 1000.0
    place = (np.arange(n) - n // 2) * SPACING
    height = -(place[:, None] ** 2 + place**2) / (2 * radius)
    side = n * SPACING
    contact = side / 16
    force = 4 / 3 * MODULUS * contact**3 / radius
    for boundary in BOUNDARIES:
        space = HalfSpace((n, n), SPACING, MODULUS, boundary=boundary)
        state = solve_contact(height, space, force=force)
        period = side if boundary == "periodic" else 2 * side
        assert state.area == pytest.approx(np.pi * contact**2, rel=0.03)
        peak = 1.5 * force / (np.pi * contact**2)
        assert state.pressure.max() == pytest.approx(peak, rel=0.01)
        if boundary == "periodic":
            above = 3.900265 * force / (np.pi * MODULUS * period)
            assert state.closure == pytest.approx(contact**2 / radius - above, rel=0.01)


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("cap", [np.inf, 300.0])
def test_dense_programmes(cap, boundary):
    height, space, _ = rough(boundary, n=32, seed=3)
    matrix, clearance = dense_operator(space), (height.max() - height).ravel()
    hardness = None if cap == np.inf else cap
    for fraction in (0.3, 0.7, 0.95):
        closure = fraction * clearance.mean()
        exact = dense_pressure(matrix, clearance, closure, min(cap, 1e6)).reshape(space.shape)
        kept = {"hardness": hardness, "rtol": 1e-9}
        by_closure = solve_contact(height, space, closure=closure, **kept)
        by_force = solve_contact(height, space, force=exact.sum() * SPACING**2, **kept)
        for state in (by_closure, by_force):
            np.testing.assert_allclose(state.pressure, exact, atol=1e-5 * exact.max())
            assert state.closure == pytest.approx(closure, rel=1e-7)


# Properties


def test_mirrored_is_periodic_on_the_reflected_surface():
    height, space, one = rough("mirrored", n=40)
    twice = HalfSpace((80, 80), SPACING, MODULUS, boundary="periodic")
    for mean in (10.0, 300.0):
        state = solve_contact(height, space, force=mean * one, rtol=1e-10)
        whole = solve_contact(reflected(height), twice, force=4 * mean * one, rtol=1e-10)
        peak = state.pressure.max()
        np.testing.assert_allclose(whole.pressure[:40, :40], state.pressure, atol=1e-6 * peak)
        assert whole.closure == pytest.approx(state.closure, rel=1e-8)


def test_periodic_states_move_with_the_surface():
    height, space, one = rough("periodic")
    state = solve_contact(height, space, force=100 * one, rtol=1e-9)
    moved = solve_contact(np.roll(height, (11, 30), (0, 1)), space, force=100 * one, rtol=1e-9)
    back = np.roll(moved.pressure, (-11, -30), (0, 1))
    np.testing.assert_allclose(back, state.pressure, atol=1e-6 * state.pressure.max())


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_loads_balance_and_rise_together(boundary):
    height, space, one = rough(boundary)
    before, areas = 0.0, 0.0
    for mean in (1.0, 10.0, 100.0, 1000.0, 5000.0):
        state = solve_contact(height, space, force=mean * one)
        assert state.pressure.sum() * SPACING**2 == pytest.approx(mean * one, rel=1e-10)
        assert state.displacement.mean() == pytest.approx(0, abs=1e-12)
        assert state.gap.mean() == pytest.approx(
            height.max() - height.mean() - state.closure, rel=1e-9, abs=1e-9
        )
        assert violation(state, height) <= 1.001e-6
        assert state.closure > before
        assert state.area >= areas
        assert 0 <= state.energy_error < 1e-5
        before, areas = state.closure, state.area
    assert before < height.max() - height.mean()


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("n", [24, 180])
def test_closure_and_force_have_the_same_state(n, boundary):
    height, space, one = rough(boundary, n=n)
    by_force = solve_contact(height, space, force=200 * one, rtol=1e-8)
    by_closure = solve_contact(height, space, closure=by_force.closure, rtol=1e-8)
    assert by_closure.force == pytest.approx(by_force.force, rel=1e-6)


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("mean", [2.0, 100.0, 1500.0])
def test_slope_is_that_of_the_curve(mean, boundary):
    height, space, one = rough(boundary, n=48)
    at = [solve_contact(height, space, force=mean * one * k, rtol=1e-10) for k in (0.9999, 1.0001)]
    secant = (at[1].force - at[0].force) / (at[1].closure - at[0].closure)
    middle = solve_contact(height, space, force=mean * one, rtol=1e-10)
    assert middle.slope.value == pytest.approx(secant, rel=1e-4)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_a_start_leads_to_the_same_state(boundary):
    height, space, one = rough(boundary, n=128)
    start = None
    for mean in (10.0, 20.0, 40.0, 80.0):
        start = solve_contact(height, space, force=mean * one, start=start, rtol=1e-8)
    cold = solve_contact(height, space, force=80 * one, rtol=1e-8)
    assert start.closure == pytest.approx(cold.closure, rel=1e-7)
    free = HalfSpace(space.shape, SPACING, MODULUS)
    from_free = solve_contact(
        height, space, force=80 * one, start=solve_contact(height, free, force=80 * one), rtol=1e-8
    )
    assert from_free.closure == pytest.approx(cold.closure, rel=1e-7)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_hardness_caps_the_pressure_up_to_the_whole_window(boundary):
    height, space, one = rough(boundary)
    for fraction in (0.01, 0.2, 0.8, 0.99):
        state = solve_contact(height, space, force=fraction * 400 * one, hardness=400.0)
        assert state.pressure.max() <= 400.0 * (1 + 1e-12)
        assert violation(state, height) <= 1.001e-6
    # With a hardness the plane may come nearer than in full contact, until all nodes yield.
    deep = solve_contact(height, space, closure=1.01 * np.ptp(height), hardness=400.0)
    assert deep.force == pytest.approx(400 * one)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_load_paths_return(boundary):
    height, space, one = rough(boundary)
    forces = [mean * one for mean in (20.0, 60.0, 10.0, 60.0, 90.0)]
    path = load_path(height, space, forces=forces, hardness=400.0)
    assert [state.branch for state in path] == ["load", "load", "unload", "reload", "load"]
    assert path[3].closure == pytest.approx(path[1].closure, rel=1e-5)
    assert path[2].closure < path[1].closure
    direct = solve_contact(height, space, force=forces[-1], hardness=400.0)
    assert path[4].closure == pytest.approx(direct.closure, rel=1e-5)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_planes_carry_any_pressure_without_approach(boundary):
    space = HalfSpace((30, 41), SPACING, MODULUS, boundary=boundary)
    state = solve_contact(np.full((30, 41), 2.0), space, force=7.0)
    np.testing.assert_allclose(state.pressure, 7.0 / (30 * 41 * SPACING**2), rtol=1e-5)
    assert state.closure == pytest.approx(0, abs=1e-12)
    assert state.slope.value == np.inf


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_closures_that_no_force_reaches_are_refused(boundary):
    height, space, _ = rough(boundary)
    mean = height.max() - height.mean()
    with pytest.raises(ValueError, match=f"no force closes this {boundary} surface further"):
        solve_contact(height, space, closure=1.0001 * mean)
    assert solve_contact(height, space, closure=0.9999 * mean).force > 0


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("shape", [(2, 1024), (3, 700), (130, 1000)])
def test_strips_take_few_applications(shape, boundary):
    """Coarse grids that do not fit into the window still repeat themselves with it."""
    height = self_affine((max(shape),) * 2, SPACING, 0.8, rms=0.1, seed=4)[: shape[0], : shape[1]]
    space = HalfSpace(shape, SPACING, MODULUS, boundary=boundary)
    state = solve_contact(height, space, force=200 * height.size * SPACING**2)
    assert violation(state, height) <= 1.001e-6
    assert state.iterations < 60


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("shape", [(1, 1), (1, 2), (1, 74), (9, 10)])
def test_small_windows_come_into_full_contact(shape, boundary):
    """On all nodes of a small window K has no inverse, which elsewhere is the preconditioner."""
    height = np.random.default_rng(3).random(shape)
    space = HalfSpace(shape, (0.12, 0.07), 0.02, boundary=boundary)
    state = solve_contact(height, space, force=1e3 * height.size * space.cell_area, rtol=1e-9)
    assert state.in_contact.all()
    assert state.iterations < 30
    assert violation(state, height) <= 1.001e-9


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_large_windows_have_no_candidates(boundary):
    height, space, one = rough(boundary, n=512)
    state = solve_contact(height, space, force=2 * one)
    assert not hasattr(state, "candidates")
    assert violation(state, height) <= 1.001e-6


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("seed", range(SCENES))
def test_random_scenes_meet_the_conditions(seed, boundary):
    """In any unit, shape and load; judged in double precision by transforms of numpy's own."""
    problem = random_problem(seed + 40, largest=60 if seed < ALWAYS else 200)
    height, free = problem.height, problem.space
    space = HalfSpace(free.shape, free.spacing, free.modulus, boundary=boundary)
    rng, load = np.random.default_rng(seed), dict(problem.load)
    mean = height.max() - height.mean()
    if load.get("closure", 0) >= mean:
        load["closure"] = mean * rng.choice([0.5, 0.99, 1 - 1e-6])
    hardness = None
    if rng.random() < 0.4:
        stress = load.get("force", 0) / (height.size * space.cell_area)
        stress = stress or space.modulus * load["closure"] / space.cell / 10
        hardness = stress * 10 ** rng.uniform(0.01, 2.5)
    try:
        state = solve_contact(height, space, **load, hardness=hardness)
    except NotConverged as error:
        pytest.fail(f"{problem.name}: {error}")
    assert violation(state, height) <= 1.001e-6
    for name, value in load.items():
        assert getattr(state, name) == pytest.approx(value, rel=1e-6)
    expected = displacement(state.pressure, space)
    scale = np.abs(expected).max() + state.pressure.max() * space.cell / space.modulus
    np.testing.assert_allclose(state.displacement, expected, rtol=0, atol=1e-11 * scale)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_the_judge_of_free_windows_refuses_others(boundary):
    height, space, area = rough(boundary)
    state = solve_contact(height, space, mean_pressure=1.0)
    assert state.force == pytest.approx(area)
    with pytest.raises(ValueError, match="expected a state of a free window"):
        violation_of_free_windows(state, height)
