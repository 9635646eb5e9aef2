"""The same surface on finer grids, and the numerical error that its states give."""

import numpy as np
import pytest

from fractalcontact.states.numerical_error import (
    UNCERTAIN_FRACTION,
    closure_numerical_error,
    numerical_error,
)
from fractalcontact.states.state_quantities import STATE_QUANTITIES, state_quantities
from fractalcontact.states.subgrid import subgrid, subgrid_states, summit
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.corrected_area import corrected_area
from roughcontact.elastic.halfspace import HalfSpace

SPACING, MODULUS = 0.1, 1e4


@pytest.fixture(scope="module")
def rough():
    return self_affine((40, 48), SPACING, 0.6, rms=0.1, seed=3)


@pytest.mark.parametrize("factor", [3, 5])
def test_old_nodes_are_among_those_of_an_odd_factor(rough, factor):
    finer = subgrid(rough, factor)
    assert finer.shape == tuple(factor * n for n in rough.shape)
    middle = factor // 2
    np.testing.assert_allclose(finer[middle::factor, middle::factor], rough, atol=1e-8)


def test_all_grids_are_samples_of_one_surface(rough):
    """Cells of s/2 and of s/6 have centres in common."""
    np.testing.assert_allclose(subgrid(rough, 6)[1::3, 1::3], subgrid(rough, 2), atol=1e-12)


def test_a_cubic_is_refined_exactly_away_from_the_edge():
    def surface(n, m):
        y, x = np.meshgrid(*2 * [(np.arange(n * m) + 0.5) / m], indexing="ij")
        return 0.3 + 0.1 * x - 0.02 * y**2 + 0.001 * x**3 + 0.002 * x * y**2

    inside = np.s_[32:-32, 32:-32]
    found, exact = subgrid(surface(40, 1), 2), surface(40, 2)
    np.testing.assert_allclose(found[inside], exact[inside], atol=1e-6 * np.ptp(exact))


def test_refined_heights_do_not_run_away_at_the_edge():
    """A plane that rises towards the edge gains less than half of what continuing it would."""
    heights = np.add.outer(np.zeros(20), 0.1 * np.arange(20.0))
    assert subgrid(heights, 4).max() <= heights.max() + 0.1 * 3 / 8 / 2


def test_summit_between_nodes_is_found():
    x = np.arange(32) + 0.5
    wave = np.cos(2 * np.pi * (x - 16.9) / 16)
    heights = np.add.outer(wave, wave)
    assert heights.max() < 2 - 0.02
    assert summit(heights) == pytest.approx(2, abs=1e-3)


def test_summit_is_that_of_a_very_fine_grid(rough):
    assert summit(rough) == pytest.approx(subgrid(rough, 16).max(), abs=1e-4 * np.ptp(rough))
    assert summit(rough + 7) - 7 == pytest.approx(summit(rough), abs=1e-9)
    assert summit(3 * rough) == pytest.approx(3 * summit(rough), rel=1e-9)


def test_summit_of_a_plane_is_its_height():
    assert summit(np.full((9, 12), 0.25)) == pytest.approx(0.25, abs=1e-12)


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.31, -0.22), (0.5, 0.5)])
def test_errors_cover_the_exact_solution_of_a_sphere(place):
    """Hertz: w = (9 F^2/(16 E*^2 R))^(1/3), a^2 = R w, dF/dw = 2 E* a, wherever the nodes lie."""
    radius, cells, force = 5.0, 32, 20.0
    y, x = ((np.arange(cells) - cells / 2 + 0.5 - p) * SPACING for p in place)
    heights = -(y[:, np.newaxis] ** 2 + x**2) / (2 * radius)
    space = HalfSpace(heights.shape, (SPACING, SPACING), MODULUS)
    values, raw = [], np.nan
    for factor in (1, 2, 4):
        ((state, highest),) = subgrid_states(heights, space, factor, [force], {"rtol": 1e-7}, "")
        values.append(list(state_quantities(state, highest).values()))
        raw = state.area if factor == 1 else raw
    closure = (9 * force**2 / (16 * MODULUS**2 * radius)) ** (1 / 3)
    contact = np.sqrt(radius * closure)
    levels = np.array(values)
    bulk = 0.946402 * force / (MODULUS * cells * SPACING)
    area = (cells * SPACING) ** 2
    stiffness = 1 / (area / (2 * MODULUS * contact) - bulk / (force / area))
    exact = [closure - bulk, -closure, np.pi * contact**2, stiffness]
    edge = (raw - levels[0, 2]) / raw
    length = edge * force / area / levels[0, 3]
    found = [
        closure_numerical_error(
            levels[0, 0], levels[:, 1], length, summit(heights) - heights.max()
        ),
        numerical_error("separation", levels[:, 1], length),
        numerical_error("area_corrected", levels[:, 2], levels[0, 2] * edge),
        numerical_error("stiffness", levels[:, 3], levels[0, 3] * edge),
    ]
    for name, of_name, value, true in zip(STATE_QUANTITIES, found, levels[0], exact, strict=True):
        assert abs(value - true) <= of_name.error, name
        assert of_name.error <= 0.25 * abs(true), name


@pytest.mark.parametrize("factor", [1, 2, 3])
def test_finer_cells_cover_the_same_window_whichever_side_is_longer(rough, factor):
    found = []
    for heights, spacing in ((rough[:20], (0.3, 0.1)), (rough[:20].T, (0.1, 0.3))):
        space = HalfSpace(heights.shape, spacing, MODULUS)
        ((state, highest),) = subgrid_states(heights, space, factor, [300.0], {"rtol": 1e-8}, "")
        sides = np.multiply(state.space.shape, state.space.spacing)
        np.testing.assert_allclose(sides, np.multiply(space.shape, space.spacing))
        found.append(state_quantities(state, highest))
    assert found[1] == pytest.approx(found[0], rel=1e-6)


def test_separation_knows_nothing_of_the_highest_node(rough):
    """A spike too thin to carry the load moves the closure, and not the separation."""
    spiked = rough.copy()
    spiked[5, 5] = rough.max() + 0.03
    space = HalfSpace(rough.shape, (SPACING, SPACING), MODULUS)
    found = [
        state_quantities(state, highest, 0.3)
        for heights in (rough, spiked)
        for state, highest in subgrid_states(heights, space, 1, [2e4], {"rtol": 1e-8}, "")
    ]
    gained = {name: found[1][name] - found[0][name] for name in STATE_QUANTITIES}
    assert gained["closure"] == pytest.approx(0.03, abs=2e-3)
    assert abs(gained["separation"]) < 2e-3


def test_state_quantities_are_those_of_the_closure_stage(rough):
    space = HalfSpace(rough.shape, (SPACING, SPACING), MODULUS)
    ((state, highest),) = subgrid_states(rough, space, 2, [300.0], {"rtol": 1e-8}, "")
    found = state_quantities(state, highest, 0.1)
    assert state.space.shape == (80, 96)
    assert state.force == pytest.approx(300, rel=1e-6)
    assert found["separation"] == pytest.approx(highest - 0.1 - state.closure)
    assert found["area_corrected"] == corrected_area(state.in_contact, SPACING / 2)
    assert found["stiffness"] > state.stiffness / (rough.size * SPACING**2)


# -- the extrapolation ---------------------------------------------------------------------------


@pytest.mark.parametrize("order", [0.7, 1.3, 2.0])
def test_a_power_law_is_extrapolated_exactly(order):
    values = 5 + 0.3 * 0.5 ** (order * np.arange(3))
    found = numerical_error("any", values)
    assert found.order == pytest.approx(order)
    assert found.limit == pytest.approx(5)
    beyond = 0.3 * 0.25**order
    assert found.error == pytest.approx(0.3 + UNCERTAIN_FRACTION * beyond)


def test_orders_are_bounded():
    assert numerical_error("any", [1.0, 0.5, 0.49]).order == 3
    assert numerical_error("any", [1.0, 0.5, 0.01]).order == 0.5


@pytest.mark.parametrize("values", [[1.0, 1.2, 1.1], [1.0, 1.1, 1.3], [1.0, 0.9, 1.05]])
def test_what_is_not_monotone_is_not_extrapolated(values):
    found = numerical_error("any", values)
    assert np.isnan(found.limit)
    assert np.isnan(found.order)
    changes = np.abs(np.subtract.outer(values, values))
    assert found.error >= changes.max()


def test_with_two_spacings_the_error_exceeds_their_change():
    found = numerical_error("any", [1.0, 1.2, np.nan])
    assert found.error == pytest.approx(0.2 * (1 + UNCERTAIN_FRACTION))
    assert np.isnan(found.limit)


def test_errors_scale_with_the_unit_and_not_with_the_zero():
    values = np.array([[1.0, 1.4, 2.0], [1.1, 1.2, 2.1], [1.15, 1.3, np.nan]])
    edge = np.array([0.1, 0.2, 0.3])
    found = numerical_error("area_corrected", values, edge)
    of_scaled = numerical_error("area_corrected", 1e3 * values, 1e3 * edge)
    np.testing.assert_allclose(of_scaled.error, 1e3 * found.error)
    plain = numerical_error("any", values).error
    np.testing.assert_allclose(numerical_error("any", values + 7).error, plain)
    assert (found.error > plain).all()


def test_closures_that_gain_only_their_summit_are_off_by_its_rise():
    found = closure_numerical_error(0.3, [0.2, 0.2, 0.2], 0.0, 0.05)
    assert found.error == pytest.approx(0.05)
    assert closure_numerical_error(0.3, [0.2, 0.2, 0.2], 0.01, 0.05).error > 0.05
