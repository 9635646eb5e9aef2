"""Where a load step starts: on the line of two earlier states, or in proportion to the load."""

import numpy as np
import pytest
from rough_surfaces import self_affine

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact import candidates, solve
from roughcontact.contact.topography import Topography

SHAPE = 40, 44
HEIGHT = self_affine(SHAPE, 0.1, 0.8, rms=0.2, seed=2)
SPACE, STIFFER = (HalfSpace(SHAPE, (0.1, 0.1), modulus) for modulus in (1e4, 3e4))


@pytest.fixture(autouse=True)
def always_candidates(monkeypatch):
    """Candidates are taken on any window, and however many."""
    monkeypatch.setattr(candidates, "MAX_CANDIDATES", 1.0)
    monkeypatch.setattr(candidates, "BATCH", 0.0)


@pytest.fixture(scope="module")
def states():
    """Two states at closures of 0.2 and 0.25, the second from the first."""
    first = solve_contact(HEIGHT, SPACE, closure=0.2)
    return first, solve_contact(HEIGHT, SPACE, closure=0.25, start=first)


def extrapolated(space, start, control, load):
    """Pressure and displacement, in MPa and mm, on the window and on candidates, and these."""
    units = solve._Units(space, load, control == "force")
    pressure, displacement = units.extrapolated(start, load)
    case = units.case(Topography(HEIGHT, SHAPE), np.inf)
    restricted, on_nodes, on_nodes_displacement = units.candidates(case, start, load)
    assert (displacement is None) == (on_nodes_displacement is None)
    if displacement is not None:
        displacement = displacement * units.length
    on_window = pressure * units.pressure
    np.testing.assert_array_equal(on_nodes * units.pressure, on_window[restricted.nodes])
    return on_window.reshape(SHAPE), displacement


@pytest.mark.parametrize("control", ["closure", "force"])
def test_two_states_of_one_half_space_are_continued_by_their_line(states, control):
    first, second = states
    load = 2 * getattr(second, control) - getattr(first, control)
    pressure, displacement = extrapolated(SPACE, second, control, load)
    largest = second.pressure.max()
    expected = 2 * second.pressure - first.pressure
    np.testing.assert_allclose(pressure, expected, rtol=0, atol=1e-9 * largest)
    expected = SPACE.displacement(expected).ravel()
    np.testing.assert_allclose(displacement, expected, rtol=0, atol=1e-9 * expected.max())


@pytest.mark.parametrize("control", ["closure", "force"])
def test_states_of_another_half_space_are_taken_in_proportion(states, control):
    _, second = states
    load = 1.5 * getattr(second, control)
    pressure, displacement = extrapolated(STIFFER, second, control, load)
    np.testing.assert_allclose(pressure, 1.5 * second.pressure, rtol=1e-12)
    assert displacement is None
    state = solve_contact(HEIGHT, STIFFER, start=second, rtol=1e-8, **{control: load})
    cold = solve_contact(HEIGHT, STIFFER, rtol=1e-8, **{control: load})
    assert state.force == pytest.approx(cold.force, rel=1e-7)
    assert state.closure == pytest.approx(cold.closure, rel=1e-7)


def test_a_single_state_is_taken_in_proportion_and_no_further_than_twice(states):
    first, _ = states
    for times, taken in ((1.2, 1.2), (9.0, solve.FURTHEST)):
        pressure, _ = extrapolated(SPACE, first, "closure", times * first.closure)
        np.testing.assert_allclose(pressure, taken * first.pressure, rtol=1e-12)
