"""Laws of the closure from a seat, and values at set pressures."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.limits import REFERENCE_PRESSURES
from fractalcontact.laws.seated_laws import (
    ON_SUSPECTS,
    add_seated_laws,
    at_reference_pressures,
    within_span,
)

PRESSURE = np.geomspace(0.25, 50, 12)
DIMS = ("direction", "offset", "resolution", "normal_force")


def curves_of(*closures, pressure=PRESSURE, seat=None, resolved=True, share=0.0):
    """Closure stages with one offset and as many resolutions (1, 2, 4) as there are curves."""
    shape = (1, 1, len(closures), len(pressure))
    values = np.reshape(closures, shape)
    seats = np.full(shape[:3], pressure[0] if seat is None else seat)
    return xr.Dataset(
        {
            "seated_closure": (DIMS, values),
            "resolved": (DIMS, np.broadcast_to(resolved, shape)),
            "suspect_load_share": (DIMS, np.broadcast_to(share, shape)),
            "seating_pressure": (DIMS[:3], seats),
            "nominal_pressure": ("normal_force", pressure),
        },
        {
            "direction": ["E"],
            "offset": [0.0],
            "resolution": 2 ** np.arange(len(closures)),
            "normal_force": 100 * pressure,
        },
    )


def seated(closure):
    return closure - closure[0]


def hyperbola(pressure, k_ni=30.0, v_m=0.4):
    return pressure * v_m / (k_ni * v_m + pressure)


def laws_of(*closures, **made):
    curves = curves_of(*closures, **made)
    add_seated_laws(curves)
    return curves.squeeze()


def test_a_hyperbola_is_found_again_with_its_range():
    """What lies beyond two decades from the seat is not fitted."""
    closure = seated(hyperbola(PRESSURE) * (1 + 1e-5 * np.cos(9 * PRESSURE)))
    closure[-1] *= 3
    found = laws_of(closure)
    assert found["seated_k_ni"] == pytest.approx(30, rel=1e-4)
    assert found["seated_v_m"] == pytest.approx(0.4, rel=1e-4)
    assert found["seated_hyperbola_misfit"] < 1e-4
    assert found["seated_fit_points"] == 9
    assert found["seated_fit_max"] == pytest.approx(PRESSURE[-3])
    assert found["seated_k_ni_determined"]
    assert found["seated_k_ni_reason"] == ""
    for end, bound in (("low", np.less_equal), ("high", np.greater_equal)):
        assert bound(found[f"seated_k_ni_{end}"], found["seated_k_ni"])


def test_a_logarithm_is_found_again():
    found = laws_of(0.07 * np.log(PRESSURE / PRESSURE[0]))
    assert found["seated_chi"] == pytest.approx(0.07, rel=1e-9)
    assert found["seated_d_0"] == pytest.approx(0.07 * np.log(1 / PRESSURE[0]), rel=1e-9)
    assert found["seated_logarithm_misfit"] < 1e-9 < found["seated_hyperbola_misfit"]


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_constants_follow_the_unit_of_length(unit):
    closure = seated(hyperbola(PRESSURE) * (1 + 0.01 * np.cos(PRESSURE)))
    one, other = laws_of(closure), laws_of(unit * closure)
    assert other["seated_k_ni"] * unit == pytest.approx(one["seated_k_ni"].item(), rel=1e-4)
    for name in ("seated_v_m", "seated_chi", "seated_d_0"):
        assert other[name] == pytest.approx(unit * one[name].item(), rel=1e-4)


def test_a_change_at_twice_the_spacing_is_that_of_k_ni():
    closures = [seated(hyperbola(PRESSURE, k_ni)) for k_ni in (20.0, 30.0)]
    found = laws_of(*closures)
    np.testing.assert_allclose(found["seated_k_ni_change"], [0.5, np.nan], rtol=1e-5)


@pytest.mark.parametrize(
    ("closure", "made", "words"),
    [
        (np.full(12, np.nan), {"seat": np.nan}, "a finer scan would help"),
        (seated(hyperbola(PRESSURE)), {"resolved": np.arange(12) < 3}, "more loads up to 25 MPa"),
        (seated(PRESSURE / 30 * (1 + 1e-3 * np.sin(PRESSURE))), {}, "heavier loads would help"),
        (
            seated(hyperbola(PRESSURE)) * (1 + 0.15 * (-1.0) ** np.arange(12)),
            {},
            "misses the curve by",
        ),
    ],
)
def test_where_k_ni_is_undetermined_the_reason_says_what_would_help(closure, made, words):
    found = laws_of(closure, **made)
    assert not found["seated_k_ni_determined"]
    assert words in found["seated_k_ni_reason"].item()


def test_a_value_at_a_pressure_is_read_off_a_power_law_exactly():
    """Between states that are known; none outside them."""
    stiffness = 12 * PRESSURE**0.9
    expected = 12 * np.array(REFERENCE_PRESSURES) ** 0.9
    np.testing.assert_allclose(at_reference_pressures(PRESSURE, stiffness), expected, rtol=1e-12)
    light = at_reference_pressures(PRESSURE, np.where(PRESSURE < 8, stiffness, np.nan))
    assert np.isfinite(light).tolist() == [True, True, False]


def test_states_on_suspicious_cells_enter_no_fit():
    """The law of the sound states is found again, whatever the others are."""
    share = np.where(PRESSURE < 1.5, 0.9, 0.2)
    closure = seated(hyperbola(PRESSURE) * (1 + 1e-5 * np.cos(9 * PRESSURE)))
    closure[1:3] *= 2
    found = laws_of(closure, share=share)
    assert found["seated_k_ni"] == pytest.approx(30, rel=1e-4)


def test_a_joint_on_suspicious_cells_under_every_load_says_so():
    found = laws_of(np.full(12, np.nan), seat=np.nan, share=0.9)
    assert not found["seated_k_ni_determined"]
    assert ON_SUSPECTS in found["seated_k_ni_reason"].item()


def test_the_span_of_the_fits_ends_at_two_decades_but_for_rounding():
    pressure = 25 * np.array([1 - 1e-12, 1, 1 + 1e-12, 1.001])
    assert within_span(pressure, 0.25).tolist() == [True, True, True, False]


@pytest.mark.parametrize(
    ("stiffness", "expected"),
    [
        ([3.0, np.nan, 3.0], [3.0, 3.0, 3.0]),
        ([3.0, 0.0, 3.0], [3.0, 3.0, 3.0]),  # no stiffness is 0
        ([3.0, np.nan, np.nan], [np.nan] * 3),
        ([np.nan, 3.0, 3.0], [np.nan, 3.0, 3.0]),
        ([3.0, 3.0, np.nan], [3.0, np.nan, np.nan]),
    ],
)
def test_a_stiffness_at_a_pressure_needs_a_state_on_either_side(stiffness, expected):
    """States at 0.5, 2 and 20 MPa; read at 1, 5 and 10 MPa."""
    found = at_reference_pressures(np.array([0.5, 2.0, 20.0]), np.array(stiffness))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_one_state_has_no_stiffness_even_at_its_own_pressure():
    assert np.isnan(at_reference_pressures(np.array([5.0]), np.array([3.0]))).all()


@pytest.mark.parametrize(("resolved", "enough"), [(4, False), (5, True)])
def test_four_states_above_the_seat_are_enough(resolved, enough):
    found = laws_of(seated(hyperbola(PRESSURE)), resolved=np.arange(12) < resolved)
    assert found["seated_fit_points"] == resolved - 1  # the seat itself is not fitted
    assert np.isfinite(found["seated_k_ni"]) == enough
    assert ("states lie above" in found["seated_k_ni_reason"].item()) != enough
