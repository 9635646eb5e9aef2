"""Load paths of contacts that crush: exact spheres, cycles, and a judge with a set of its own."""

from itertools import pairwise

import numpy as np
import pytest
from dense_programmes import dense_operator, dense_pressure
from ensembles import ensemble
from rough_surfaces import self_affine

from roughcontact.contact.path import BRANCHES, load_path
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

E_STAR, RADIUS, HARDNESS = 1e4, 1000.0, 20.0
#: Closure and force at which the peak pressure of Hertz is the hardness.
YIELD_CLOSURE = (np.pi * HARDNESS / (2 * E_STAR)) ** 2 * RADIUS
YIELD_FORCE = np.pi**3 * RADIUS**2 * HARDNESS**3 / (6 * E_STAR**2)
#: What the nodes leave of the exact numbers at 512 across; it falls with their spacing.
SPHERE_ERROR = 1e-3 * 512 / ensemble("nodes across a sphere")


def sphere(side):
    """A sphere on a window of some side, mm, whose apex is a node."""
    n = ensemble("nodes across a sphere") + 1
    x = (np.arange(n) - n // 2) * (side / n)
    return -(x[:, None] ** 2 + x**2) / (2 * RADIUS), HalfSpace((n, n), side / n, E_STAR)


def rough(seed, n=64):
    """A rough face, its half-space and the force under which all of it yields, by hardness."""
    height = self_affine((n, n), 0.05, 0.8, rms=0.1, seed=seed, roll_off=1.0)
    space = HalfSpace((n, n), 0.05, E_STAR)
    return height, space, space.cell_area * n * n


def drawn(seed):
    """A rough face and a hardness of 1e-3 to 1 of the modulus; a force up to 0.8 of the most."""
    generator = np.random.default_rng([39, seed])
    height, space, area = rough(seed)
    hardness = E_STAR * 10 ** generator.uniform(-3, -0.5)
    return height, space, hardness, area * min(0.8 * hardness, 10 ** generator.uniform(0, 2.5))


@pytest.fixture(scope="module")
def far_beyond():
    """Loading of a sphere to 100 times its elastic limit, unloading, and unloading in full."""
    force = 100 * YIELD_FORCE
    radius = np.sqrt(force / (np.pi * HARDNESS))
    height, space = sphere(2.4 * radius)
    return radius, load_path(height, space, forces=[force, 0.999 * force, 0.0], hardness=HARDNESS)


def test_sphere_begins_to_yield_at_its_elastic_limit():
    height, space = sphere(2.4 * np.sqrt(RADIUS * YIELD_CLOSURE))
    below, above = (1 - 2 * SPHERE_ERROR) * YIELD_CLOSURE, (1 + 2 * SPHERE_ERROR) * YIELD_CLOSURE
    states = load_path(height, space, closures=[below, YIELD_CLOSURE, above], hardness=HARDNESS)
    assert not states[0].yielded.any()
    assert states[0].dissipated_energy == 0
    assert states[1].force == pytest.approx(YIELD_FORCE, rel=SPHERE_ERROR)
    assert states[1].pressure.max() == pytest.approx(HARDNESS, rel=SPHERE_ERROR)
    assert states[2].yielded.any()


def test_sphere_far_beyond_carries_the_hardness_on_its_area(far_beyond):
    radius, (state, *_) = far_beyond
    assert state.contact.area * HARDNESS == pytest.approx(state.force, rel=SPHERE_ERROR)
    exact = radius**2 / (2 * RADIUS) + 4 * HARDNESS * radius / (np.pi * E_STAR)
    assert state.closure == pytest.approx(exact, rel=SPHERE_ERROR)
    assert state.plastic_load_fraction > 0.95


def test_sphere_unloads_as_a_flat_punch(far_beyond):
    radius, (top, below, empty) = far_beyond
    slope = (top.force - below.force) / (top.closure - below.closure)
    assert slope == pytest.approx(2 * radius * E_STAR, rel=SPHERE_ERROR)
    recovered = top.closure - empty.closure
    assert recovered == pytest.approx(2 * HARDNESS * radius / E_STAR, rel=SPHERE_ERROR)


@pytest.mark.parametrize("seed", range(3))
def test_loading_does_not_depend_on_its_steps(seed):
    height, space, hardness, force = drawn(seed)
    once = load_path(height, space, forces=[force], hardness=hardness, rtol=1e-8)[-1]
    steps = np.linspace(0, force, 13)[1:]
    often = load_path(height, space, forces=steps, hardness=hardness, rtol=1e-8)[-1]
    assert often.closure == pytest.approx(once.closure, rel=1e-6)
    np.testing.assert_allclose(
        often.permanent_set, once.permanent_set, rtol=0, atol=1e-6 * once.closure
    )
    np.testing.assert_allclose(often.pressure, once.pressure, rtol=0, atol=1e-4 * hardness)


@pytest.mark.parametrize("seed", range(3))
def test_turns_interrupt_the_loading_curve_and_change_nothing(seed):
    """Unloading begins on the curve, reloading returns to it, a second cycle is the first."""
    height, space, hardness, force = drawn(seed)
    down = [force, 0.5 * force, 0.0, 0.5 * force, force]
    path = load_path(height, space, forces=[*down, *down[1:], 1.2 * force], hardness=hardness)
    names = [state.branch for state in path]
    assert names == ["load", *2 * ["unload", "unload", "reload", "reload"], "load"]
    assert set(names) == set(BRANCHES)
    top, tolerance = path[0], 1e-5 * path[0].closure
    assert top.yielded.any()
    for state in path[1:9]:
        assert (state.permanent_set == top.permanent_set).all()
        assert state.pressure.max() <= hardness * (1 + 1e-4)
    for state in (path[4], path[8]):  # at the maximum again
        assert state.closure == pytest.approx(top.closure, abs=tolerance)
        np.testing.assert_allclose(state.pressure, top.pressure, rtol=0, atol=1e-3 * hardness)
    for first, second in zip(path[1:5], path[5:9], strict=True):
        assert second.closure == pytest.approx(first.closure, abs=tolerance)
    for falling, rising in ((path[1], path[3]), (path[2], path[6])):
        assert rising.closure == pytest.approx(falling.closure, abs=tolerance)
    straight = load_path(height, space, forces=[1.2 * force], hardness=hardness)[0]
    assert path[-1].closure == pytest.approx(straight.closure, abs=tolerance)
    assert (path[-1].permanent_set >= top.permanent_set - tolerance).all()


@pytest.mark.parametrize("seed", range(3))
def test_unloading_continues_the_loading_curve_without_a_step(seed):
    height, space, hardness, force = drawn(seed)
    top, below = load_path(
        height, space, forces=[force, (1 - 1e-6) * force], hardness=hardness, rtol=1e-9
    )
    drop = (top.force - below.force) / below.contact.stiffness
    assert top.closure - below.closure == pytest.approx(drop, rel=1e-3, abs=1e-8 * top.closure)


@pytest.mark.parametrize("seed", range(ensemble("cycles of random surfaces")))
def test_energy_is_stored_or_dissipated_and_never_created(seed):
    """The force rises with the closure, so its sums over steps bracket the work of each branch."""
    height, space, hardness, force = drawn(seed)
    up = force * np.linspace(0, 1, 9) ** 2
    path = load_path(height, space, forces=[*up, *up[-2::-1]], hardness=hardness, rtol=1e-8)
    forces = np.array([state.force for state in path])
    closures = np.array([state.closure for state in path])
    steps = np.diff(closures)
    assert (steps[:8] > 0).all()
    assert (steps[8:] < 0).all()
    early, late = forces[:-1] * steps, forces[1:] * steps
    top, empty = path[8], path[-1]
    work = top.elastic_energy + top.dissipated_energy
    rounding = 1e-6 * work
    assert early[:8].sum() - rounding <= work <= late[:8].sum() + rounding
    assert early[8:].sum() - rounding <= -top.elastic_energy <= late[8:].sum() + rounding
    assert empty.elastic_energy == 0
    dissipated = [state.dissipated_energy for state in path]
    assert (np.diff(dissipated) >= -rounding).all()
    assert empty.closure >= 0
    assert empty.dissipated_energy == pytest.approx(hardness * empty.set_volume)


def judged(height, space, closures, hardness):
    """Forces and permanent sets of a path, by dense programmes bounded on every branch.

    The set is held after every load, not at turns alone, and unloading is bounded like loading.
    """
    datum, pressed = height.max(), height.ravel().copy()
    matrix = dense_operator(space)
    for closure in closures:
        near = datum - pressed < closure  # no other node can touch
        p = np.zeros(pressed.size)
        if near.any():
            block = matrix[np.ix_(near, near)]
            p[near] = dense_pressure(block, (datum - pressed)[near], closure, hardness)
        gap = matrix @ p + (datum - pressed) - closure
        pressed += np.where(p >= hardness, np.minimum(gap, 0.0), 0.0)
        yield p.sum() * space.cell_area, height.ravel() - pressed


@pytest.mark.parametrize("seed", range(ensemble("paths between bounds")))
def test_path_of_five_turns_is_that_of_dense_programmes(seed):
    generator = np.random.default_rng([40, seed])
    shape = tuple(generator.integers(10, ensemble("side of a path between bounds") + 1, 2))
    height = self_affine((48, 48), 0.05, generator.uniform(0.3, 0.9), rms=0.1, seed=seed)
    height = height[: shape[0], : shape[1]]
    space = HalfSpace(shape, (0.05, 0.05 * generator.uniform(0.5, 2)), E_STAR)
    hardness = E_STAR * 10 ** generator.uniform(-3, 0)
    most = np.quantile(height.max() - height, generator.uniform(0.05, 0.6))
    ends = [0.0]
    for turn in range(6):
        low, high = (0.3, 1.0) if turn % 2 == 0 else (0.0, 1.0)
        ends.append((most if turn % 2 == 0 else ends[-1]) * generator.uniform(low, high))
    closures = [w for a, b in pairwise(ends) for w in ((a + b) / 2, b)]
    states = load_path(height, space, closures=closures, hardness=hardness, rtol=1e-9)
    exact = list(judged(height, space, closures, hardness))
    largest = max(force for force, _ in exact)
    for state, (force, pressed) in zip(states, exact, strict=True):
        assert state.force == pytest.approx(force, rel=1e-5, abs=1e-8 * largest)
        np.testing.assert_allclose(state.permanent_set.ravel(), pressed, rtol=0, atol=1e-6 * most)


def test_lost_contact_leaves_a_gap_above_what_was_pressed_in():
    height, space, hardness, force = drawn(1)
    top = load_path(height, space, forces=[force], hardness=hardness)[0]
    residual = load_path(height, space, forces=[force, 0.0], hardness=hardness)[-1].closure
    closures = [top.closure, 0.5 * residual, 0.0, top.closure]
    path = load_path(height, space, closures=closures, hardness=hardness)
    for state, closure in zip(path, closures, strict=True):
        assert state.closure == pytest.approx(closure, abs=1e-12)
    lifted = path[1]
    assert lifted.force == 0
    pressed = height - lifted.permanent_set
    np.testing.assert_allclose(lifted.gap, height.max() - pressed - lifted.closure, atol=1e-12)
    assert lifted.gap.min() == pytest.approx(0.5 * residual, rel=1e-6)
    assert path[3].force == pytest.approx(top.force, rel=1e-5)


def test_without_a_hardness_nothing_is_pressed_in():
    height, space, _, force = drawn(2)
    path = load_path(height, space, forces=[force, 0.5 * force, force], hardness=None)
    alone = solve_contact(height, space, force=0.5 * force)
    assert path[1].closure == pytest.approx(alone.closure, rel=1e-6)
    assert path[2].closure == pytest.approx(path[0].closure, rel=1e-6)
    assert path[2].dissipated_energy == 0
    assert not path[2].yielded.any()


def test_hardness_of_each_node_presses_in_the_soft_ones_alone():
    height, space, hardness, force = drawn(0)
    soft = np.random.default_rng(3).random(height.shape) < 0.5
    path = load_path(height, space, forces=[force, 0.0], hardness=np.where(soft, hardness, np.inf))
    assert path[-1].yielded.any()
    assert not path[-1].permanent_set[~soft].any()
    assert path[-1].dissipated_energy == pytest.approx(hardness * path[-1].set_volume)


@pytest.mark.parametrize(
    ("loads", "message"),
    [
        ({}, "exactly one of forces="),
        ({"forces": [1.0], "closures": [1.0]}, "exactly one of forces="),
        ({"forces": [1.0, -1.0]}, "forces: expected"),
        ({"forces": [[1.0]]}, "forces: expected"),
        ({"closures": [np.nan]}, "closures: expected"),
        ({"closures": ["1"]}, "closures of type"),
    ],
)
def test_loads_that_are_no_path_are_refused(loads, message):
    height, space, hardness, _ = drawn(0)
    with pytest.raises(ValueError, match=message):
        load_path(height, space, hardness=hardness, **loads)


def test_a_path_goes_on_from_a_state_that_is_solved():
    height, space, hardness, force = drawn(0)
    loads = [force, 0.4 * force, 0.0, 1.1 * force]
    whole = load_path(height, space, forces=loads, hardness=hardness, rtol=1e-8)
    going = {"hardness": hardness, "rtol": 1e-8, "loaded": whole[0].contact}
    rest = load_path(height, space, forces=loads[1:], **going)
    for one, other in zip(whole[1:], rest, strict=True):
        assert other.branch == one.branch
        assert other.closure == pytest.approx(one.closure, rel=1e-6)
        assert other.dissipated_energy == pytest.approx(one.dissipated_energy, rel=1e-6)
    with pytest.raises(ValueError, match="loaded: expected"):
        load_path(height, HalfSpace(space.shape, 0.1, E_STAR), forces=loads, **going)


def test_a_path_of_mean_pressures_is_that_of_their_forces():
    height, space, area = rough(3)
    pressures = [2.0, 0.5, 1.0]
    by_pressure = load_path(height, space, mean_pressures=pressures, hardness=800)
    by_force = load_path(height, space, forces=[p * area for p in pressures], hardness=800)
    for one, other in zip(by_pressure, by_force, strict=True):
        assert one.branch == other.branch
        assert np.array_equal(one.pressure, other.pressure)
    with pytest.raises(ValueError, match="exactly one of forces=, closures= and mean_pressures="):
        load_path(height, space, mean_pressures=pressures, forces=pressures)
