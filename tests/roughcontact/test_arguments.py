"""What users hand over is refused in one sentence where it cannot be meant, and never crashes."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from refused import BEYOND, GRID, NAN, NO_LOADS, NO_NUMBERS, SHAPE, masked
from rough_surfaces import self_affine

from roughcontact import HalfSpace, NotConverged, arguments, solve_contact
from roughcontact.contact.bounds import Bounds
from roughcontact.contact.dense import inverted, times
from roughcontact.contact.kkt import kkt_residual, mean_closure
from roughcontact.contact.nested_iteration import prolong, prolong_constant
from roughcontact.contact.operator import Operator
from roughcontact.contact.preconditioner import Preconditioner
from roughcontact.contact.projected_cg import ProjectedCG, add
from roughcontact.contact.state import ContactState
from roughcontact.elastic.convolution import Convolution


class Labelled:
    """An array of another library, which numpy can read."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.values, dtype)


@pytest.fixture(scope="module")
def height():
    return self_affine(SHAPE, 0.1, 0.8, rms=0.1, seed=0)


@pytest.fixture(scope="module")
def space():
    return HalfSpace(SHAPE, (0.1, 0.1), 2e4)


# Shapes, before compiled code is reached


@pytest.mark.parametrize("shape", [(3, 4), (24,), (720,), (30, 24), (2, 24, 30), (24, 31), (0, 30)])
def test_pressures_on_another_grid_are_refused(space, shape):
    with pytest.raises(ValueError, match=r"pressure \(.*\): expected the grid's \(24, 30\)"):
        space.displacement(np.ones(shape))


@pytest.mark.parametrize("values", [NAN, GRID * np.inf, -GRID * np.inf, 1e301 * GRID])
def test_pressures_that_are_not_finite_are_refused(space, values):
    with pytest.raises(ValueError, match="pressure: expected finite numbers"):
        space.displacement(np.where(np.arange(720).reshape(SHAPE) == 7, values, 1.0))


@pytest.mark.parametrize("kind", NO_NUMBERS)
def test_pressures_that_are_no_real_numbers_are_refused(space, kind):
    values, message = NO_NUMBERS[kind]
    with pytest.raises(ValueError, match=f"pressure.* {message}|pressure: {message}"):
        space.displacement(values)


@pytest.mark.parametrize("read", [list, np.ma.array, Labelled, np.asfortranarray, np.float32])
def test_pressures_of_any_array_are_displaced_alike(space, read):
    values = np.random.default_rng(1).integers(0, 9, SHAPE).astype(float)
    expected = space.displacement(values)
    np.testing.assert_array_equal(space.displacement(read(values)), expected)
    np.testing.assert_array_equal(space.displacement(values.astype(">f8")), expected)
    np.testing.assert_array_equal(space.displacement(values.astype(int)), expected)


@pytest.mark.parametrize("shape", [(3, 4), (24,), (5, 3, 4), (24, 31), (3, 30, 24), ()])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_operator_refuses_other_grids(space, shape, dtype):
    with pytest.raises(ValueError, match="expected"):
        space.convolve(np.ones(shape, dtype))


@pytest.mark.parametrize(
    "values",
    [*(GRID.astype(kind) for kind in (int, complex, ">f8", "f2", bool)), list(GRID[:3]), masked()],
)
def test_the_operator_refuses_other_types(space, values):
    with pytest.raises(ValueError, match=r"expected|masked"):
        space.convolve(values)


@pytest.mark.parametrize("shape", [(0, 24, 30), (2, 3, 24, 30)])
def test_the_operator_takes_stacks_of_fields(space, shape):
    assert space.convolve(np.ones(shape)).shape == shape


@pytest.mark.parametrize("factor", [0, -2, 2.0, 1.5, "2", True, None, 10**400])
def test_coarser_cells_are_a_whole_number_of_cells_wide(space, factor):
    with pytest.raises(ValueError, match=r"factor .*: expected a whole number from 1"):
        space.coarser(factor)


@pytest.mark.parametrize(
    ("spectrum", "shape", "padded", "dtype"),
    [
        ((9, 33), (8, 31), (16, 64), np.float16),
        ((9, 33), (8, 31), (15, 60), np.float32),
        ((9, 33), (8, 33), (16, 64), np.float32),
        ((8, 33), (8, 31), (16, 64), np.float64),
        ((9, 34), (8, 31), (16, 66), np.float64),
        ((9, 33), (0, 31), (16, 64), np.float64),
    ],
)
def test_convolutions_whose_lengths_do_not_go_together_are_refused(spectrum, shape, padded, dtype):
    with pytest.raises(ValueError, match="expected"):
        Convolution(np.ones(spectrum), shape, padded, dtype)


def kernel_calls():
    """Calls of what is compiled, with arrays that are too short, too long or point elsewhere."""
    space = HalfSpace((24, 30), (0.1, 0.1), 2e4)
    nodes = np.arange(100, 300, dtype=np.int32)
    inverse = Preconditioner(space)
    inverse.update(nodes, fresh=True)
    few = Preconditioner(space)
    few.update(nodes[:5], fresh=True)
    operator = Operator(space)
    ones = np.ones(200, np.float32)
    n10, n9 = np.ones(10), np.ones(9)
    yield "too many residuals", lambda: inverse(np.ones(201, np.float32))
    yield "too few residuals", lambda: inverse(np.ones(7, np.float32))
    yield "residuals in double precision", lambda: inverse(np.ones(200))
    yield "residuals of few nodes", lambda: few(np.ones(6, np.float32))
    yield "nodes past the grid", lambda: inverse.update(nodes + 600, fresh=True)
    yield "negative nodes", lambda: inverse.update(nodes - 200, fresh=True)
    yield "nodes twice", lambda: inverse.update(np.repeat(nodes, 2), fresh=True)
    yield "nodes of another type", lambda: inverse.update(nodes.astype(int), fresh=True)
    yield "nodes as a mask", lambda: inverse.update(np.ones((24, 30), bool), fresh=True)
    yield "loads past the grid", lambda: operator.apply_sparse((nodes + 600, ones))
    yield "loads for other nodes", lambda: operator.apply_sparse((nodes, ones[1:]))
    yield "another right side", lambda: ProjectedCG(operator, nodes, ones[1:])
    yield "cells for other nodes", lambda: prolong_constant(np.ones((2, 2)), (24, 30))
    yield "pressures on another grid", lambda: prolong(np.ones((9, 9)), GRID, GRID)
    yield "influence on another grid", lambda: prolong(np.ones((12, 15)), GRID, np.ones((2, 2)))
    yield "clearance of another grid", lambda: kkt_residual(n10, n10, n9, 1.0, Bounds())
    yield "displacement of another grid", lambda: mean_closure(n10, n9, n10, Bounds())
    yield "too few changes", lambda: add(n10, 1.0, n9)
    yield "too many values", lambda: times(np.ones((3, 3), np.float32), ones)
    yield "no square matrix", lambda: inverted(np.ones((3, 2)))


@pytest.mark.parametrize(("name", "call"), list(kernel_calls()))
def test_kernels_are_not_reached_with_arrays_that_do_not_go_together(name, call):
    with pytest.raises(ValueError, match="expected"):
        call()


# Numbers


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((2.5, 3), (1.0, 1.0), 1.0), r"shape 2\.5: expected a whole number from 1"),
        ((("24", "24"), (1.0, 1.0), 1.0), "shape '24': expected a whole number"),
        (("24", (1.0, 1.0), 1.0), "shape '24': expected two numbers"),
        (((True, 4), (1.0, 1.0), 1.0), "shape True: expected a whole number"),
        ((24, (1.0, 1.0), 1.0), "shape 24: expected two numbers"),
        (((4, 4, 4), (1.0, 1.0), 1.0), r"shape \(4, 4, 4\): expected two numbers"),
        (((10**400, 4), (1.0, 1.0), 1.0), "shape an integer of 1329 bits: expected a whole"),
        (((2**20, 2**20), (1.0, 1.0), 1.0), "expected no more than 2147483647 cells"),
        (((4, 4), ("0.1", "0.1"), 1.0), "spacing '0.1': expected a plain number, in mm"),
        (((4, 4), "01", 1.0), "spacing '01': expected two numbers"),
        (((4, 4), (True, True), 1.0), "spacing True: expected a plain number"),
        (((4, 4), (1e-200, 1e-200), 1.0), r"spacing 1e-200: expected between 1e-150 and 1e\+150"),
        (((4, 4), (1e200, 1e200), 1.0), r"spacing 1e\+200: expected between"),
        (((4, 4), (1.0, 1.0), "10 GPa"), "modulus '10 GPa': expected a plain number, in MPa"),
        (((4, 4), (1.0, 1.0), True), "modulus True: expected a plain number"),
        (((4, 4), (1.0, 1.0), 1 + 0j), "modulus .*: expected a plain number"),
        (((4, 4), (1.0, 1.0), [1.0, 2.0]), "modulus .*: expected a plain number"),
        (((4, 4), (1.0, 1.0), 5e-324), "modulus .*: expected between"),
        (((4, 4), (1.0, 1.0), 10**400), "modulus inf: expected between"),
    ],
)
def test_half_spaces_of_what_is_no_number_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        HalfSpace(*arguments)


@pytest.mark.parametrize("kernel", [None, ["love"], 3, np.ones(3)])
def test_kernels_that_are_no_names_are_refused(kernel):
    with pytest.raises(ValueError, match=r"kernel .*: expected one of love"):
        HalfSpace((4, 4), (1.0, 1.0), 1.0, kernel=kernel)


def test_numbers_of_any_library_are_numbers(height, space):
    expected = solve_contact(height, space, closure=0.25)
    for closure in (np.float32(0.25), np.array(0.25), Labelled(0.25)):
        state = solve_contact(Labelled(height), space, closure=closure)
        np.testing.assert_array_equal(state.pressure, expected.pressure)
    shape = np.array(SHAPE)
    assert HalfSpace(shape, np.array([0.1, 0.1]), np.int64(20000)) == space


@pytest.mark.parametrize(("load", "message"), NO_LOADS)
def test_loads_that_are_no_numbers_are_refused(height, space, load, message):
    with pytest.raises(ValueError, match=message):
        solve_contact(height, space, **load)


# Arrays


@pytest.mark.parametrize("kind", NO_NUMBERS)
def test_heights_that_are_no_real_numbers_are_refused(space, kind):
    values, message = NO_NUMBERS[kind]
    with pytest.raises(ValueError, match=f"composite topography.* {message}"):
        solve_contact(values, space, closure=0.1)


def test_a_masked_array_without_masked_cells_is_an_array(height, space):
    expected = solve_contact(height, space, closure=0.2)
    state = solve_contact(np.ma.array(height, mask=False), space, closure=0.2)
    np.testing.assert_array_equal(state.pressure, expected.pressure)


def test_heights_deeper_than_numbers_go_are_refused(height, space):
    for deep in (height * 1e200, np.where(height > 0, 1.7e308, -1.7e308)):
        with pytest.raises(ValueError, match=r"deep: expected 1e\+150 at most"):
            solve_contact(deep, space, force=1.0)


@pytest.mark.parametrize("space", [None, (24, 30), "space"])
def test_what_is_no_half_space_is_refused(height, space):
    with pytest.raises(ValueError, match=r"space .*: expected a HalfSpace"):
        solve_contact(height, space, closure=0.1)


# Loads at which double precision ends


@pytest.mark.parametrize("load", BEYOND)
def test_loads_beyond_double_precision_are_refused(height, space, load):
    with pytest.raises(ValueError, match=r"(small|large) for double precision; expected such that"):
        solve_contact(height, space, **load)


def test_the_limits_do_not_depend_on_how_a_load_is_given(height, space):
    tiny = solve_contact(height, space, closure=1e-290)
    assert solve_contact(height, space, force=tiny.force).closure == pytest.approx(1e-290, rel=1e-6)


# Starts


@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("name", ["pressure", "displacement"])
def test_starts_that_are_not_finite_are_refused(height, space, name, value):
    start = solve_contact(height, space, closure=0.2)
    values = getattr(start, name).copy()
    values[2, 3] = value
    with pytest.raises(ValueError, match=f"{name} of the start: expected finite numbers"):
        solve_contact(height, space, closure=0.3, start=replace(start, **{name: values}))


@pytest.mark.parametrize("kind", NO_NUMBERS)
def test_starts_that_are_no_real_numbers_are_refused(height, space, kind):
    start = solve_contact(height, space, closure=0.2)
    values, message = NO_NUMBERS[kind]
    with pytest.raises(ValueError, match=f"pressure of the start.* {message}"):
        solve_contact(height, space, closure=0.3, start=replace(start, pressure=values))


@pytest.mark.parametrize("name", ["closure", "force"])
@pytest.mark.parametrize("value", [np.nan, np.inf, "0.2"])
def test_starts_of_no_load_are_refused(height, space, name, value):
    start = solve_contact(height, space, closure=0.2)
    with pytest.raises(ValueError, match=f"{name} of the start.*: expected a"):
        solve_contact(height, space, closure=0.3, start=replace(start, **{name: value}))


@pytest.mark.parametrize("start", [np.ones(SHAPE), {"pressure": 1}, 0.2, NotConverged])
def test_starts_that_are_no_states_are_refused(height, space, start):
    with pytest.raises(ValueError, match=r"start .*: expected a ContactState"):
        solve_contact(height, space, closure=0.3, start=start)


def test_starts_in_single_precision_start_as_well(height, space):
    start = solve_contact(height, space, closure=0.2)
    single = replace(
        start,
        pressure=start.pressure.astype(np.float32),
        displacement=np.ma.array(start.displacement),
    )
    state = solve_contact(height, space, closure=0.3, start=single)
    assert isinstance(state, ContactState)
    assert state.residual <= 1e-6


# The sentences themselves


def test_messages_stay_short_whatever_is_handed_over(height, space):
    for load in (10**5000, "9" * 10**6, list(range(10**5)), np.ones((500, 500)), [10**5000]):
        with pytest.raises(ValueError, match="force") as caught:
            solve_contact(height, space, force=load)
        assert len(str(caught.value)) < 200
        assert str(caught.value).count("\n") <= 3


def test_nothing_is_refused_with_a_warning_of_numpy(height, space):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for values, _ in NO_NUMBERS.values():
            with pytest.raises(ValueError, match="composite"):
                solve_contact(values, space, closure=0.1)
        with pytest.raises(ValueError, match="closure"):
            solve_contact(height, space, closure=1e-310)


def test_whole_numbers_are_those_of_numpy_too():
    assert arguments.whole_number(np.int32(3), "n", least=1, most=3) == 3
    assert arguments.whole_numbers([1.0, 3.0], "n", least=1, most=3).tolist() == [1, 3]
    with pytest.raises(ValueError, match=r"n \[1.0, 2.5\]: expected a list of whole numbers"):
        arguments.whole_numbers([1.0, 2.5], "n", least=1, most=3)
