"""What users hand over is refused by comparison methods and cheap models as by the solver."""

from dataclasses import replace

import numpy as np
import pytest
from refused import BEYOND, NAN, NO_LOADS, NO_NUMBERS, SHAPE, masked

from contactlab.accuracy.cheap_models import bearing_area, coarse_grid, winkler
from contactlab.methods.common import measured_state
from contactlab.methods.registry import METHODS
from fractalcontact import HalfSpace, NotConverged, solve_contact
from fractalcontact.surface.synthesis import self_affine


@pytest.fixture(scope="module")
def height():
    return self_affine(SHAPE, 0.1, 0.8, rms=0.1, seed=0)


@pytest.fixture(scope="module")
def space():
    return HalfSpace(SHAPE, (0.1, 0.1), 2e4)


#: The solver itself, and those it is compared with.
SOLVERS = {"": solve_contact, **METHODS}


def offered(loads):
    """Pairs of a method and a load that it does not refuse for its kind."""

    def offers(name, closure=None, force=None, hardness=None, rtol=None):
        return not METHODS[name]._lack(closure, force, hardness, "")

    return [(name, *load) for name in METHODS for load in loads if offers(name, **load[0])]


@pytest.mark.parametrize(("method", "load", "message"), offered(NO_LOADS))
def test_loads_that_are_no_numbers_are_refused(height, space, method, load, message):
    with pytest.raises(ValueError, match=message):
        METHODS[method](height, space, **load)


@pytest.mark.parametrize("kind", NO_NUMBERS)
@pytest.mark.parametrize("method", METHODS)
def test_heights_that_are_no_real_numbers_are_refused(space, method, kind):
    values, message = NO_NUMBERS[kind]
    with pytest.raises(ValueError, match=f"composite topography.* {message}"):
        METHODS[method](values, space, closure=0.1)


@pytest.mark.parametrize("model", [bearing_area, winkler, coarse_grid])
def test_cheap_models_refuse_masked_heights(space, model):
    with pytest.raises(ValueError, match="2 masked cells"):
        model(masked(), space, closure=0.1)


@pytest.mark.parametrize(("method", "load"), offered([(load,) for load in BEYOND]))
def test_loads_beyond_double_precision_are_refused(height, space, method, load):
    with pytest.raises(ValueError, match=r"(small|large) for double precision; expected such that"):
        METHODS[method](height, space, **load)


@pytest.mark.parametrize(
    "power",
    [-290, *(pytest.param(power, marks=pytest.mark.full) for power in (-200, -100, 100, 290)), 200],
)
@pytest.mark.parametrize("method", SOLVERS)
def test_loads_within_it_have_their_state_or_none(height, space, method, power):
    """One node, or all of them, carry such closures; nothing that is no number is returned."""
    if method == "polonsky-keer" and abs(power) > 140:
        with pytest.raises(ValueError, match="conjugate gradients square gaps"):
            METHODS[method](height, space, closure=10.0**power)
        return
    state = SOLVERS[method](height, space, closure=10.0**power)
    expected = METHODS["dense"](height, space, closure=10.0 ** (power // 10))
    assert state.force / 10.0**power == pytest.approx(
        expected.force / 10.0 ** (power // 10), rel=1e-5
    )
    assert (state.pressure > 0).sum() in (1, state.pressure.size)


def test_what_is_no_number_is_no_state(height, space):
    """A violation that is not a number compares with nothing, and once passed for none."""
    state = measured_state(space, height.max() - height, NAN, 0.1)
    assert np.isnan(state.residual)
    assert not state.residual <= 1e-6


@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("name", ["pressure", "displacement"])
@pytest.mark.parametrize("method", METHODS)
def test_starts_that_are_not_finite_are_refused(height, space, method, name, value):
    start = solve_contact(height, space, closure=0.2)
    values = getattr(start, name).copy()
    values[2, 3] = value
    with pytest.raises(ValueError, match=f"{name} of the start: expected finite numbers"):
        METHODS[method](height, space, closure=0.3, start=replace(start, **{name: values}))


@pytest.mark.parametrize("start", [np.ones(SHAPE), {"pressure": 1}, 0.2, NotConverged])
@pytest.mark.parametrize("method", METHODS)
def test_starts_that_are_no_states_are_refused(height, space, method, start):
    with pytest.raises(ValueError, match=r"start .*: expected a ContactState"):
        METHODS[method](height, space, closure=0.3, start=start)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("boundary", ["periodic", "mirrored"])
def test_windows_that_go_on_beyond_their_edges_are_refused(height, method, boundary):
    space = HalfSpace(SHAPE, 0.1, 2e4, boundary=boundary)
    with pytest.raises(ValueError, match=f"know free windows, not {boundary} ones"):
        METHODS[method](height, space, closure=0.01)
