"""Constants of closure laws: their intervals hold other readings and registrations."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.intervals import t_quantile
from fractalcontact.error_budget.closure_constants import closure_constants, seated_constants
from fractalcontact.states.state_quantities import SOUND

PRESSURE = np.geomspace(0.25, 25, 9)


def hyperbola(k_ni, v_m=0.4):
    """Closure from first touch, mm; a ripple gives the fit an interval."""
    return PRESSURE * v_m / (k_ni * v_m + PRESSURE) * (1 + 1e-4 * np.cos(9 * PRESSURE))


def curve_of(k_ni=30.0, change=np.nan, reason=""):
    own = seated_constants(PRESSURE, hyperbola(k_ni), np.ones(9, bool), 0.25)
    values = {
        f"seated_{name}{end}": own[name] * size
        for name in own
        for end, size in (("", 1.0), ("_low", 0.99), ("_high", 1.02))
    }
    values |= {"seated_k_ni_change": change, "seated_k_ni_reason": reason}
    return xr.Dataset(values, {"nominal_pressure": ("normal_force", PRESSURE)})


def values_of(*closures, sound=None):
    shape = (len(closures), len(PRESSURE))
    return {
        "closure": np.array(closures),
        SOUND: np.ones(shape) if sound is None else np.broadcast_to(sound, shape).astype(float),
    }


def of(constants, name):
    return [constants[f"{name}{end}"][1] for end in ("", "_low", "_high")]


def test_constants_are_those_that_the_closures_follow():
    found = seated_constants(PRESSURE, hyperbola(20.0), np.ones(9, bool), 0.25)
    assert found["k_ni"] == pytest.approx(20.0, rel=1e-2)
    assert found["v_m"] == pytest.approx(0.4, rel=1e-2)
    # Another level of the closures, and light states that no fit takes, change nothing.
    closure = hyperbola(20.0) + 0.7
    closure[:2] += 0.3
    sound = np.arange(9) > 1
    assert seated_constants(PRESSURE, closure, sound, 0.25)["k_ni"] == pytest.approx(20, rel=2e-2)
    none = seated_constants(PRESSURE, closure, np.zeros(9, bool), 0.25)
    assert np.isnan(list(none.values())).all()


def test_one_scan_has_the_interval_of_the_fit():
    curve = curve_of()
    constants = closure_constants(curve, 0.25, None, None)
    for name in ("k_ni", "v_m", "chi"):
        expected = [float(curve[f"seated_{name}{end}"]) for end in ("", "_low", "_high")]
        np.testing.assert_allclose(of(constants, name), expected)


def test_the_interval_holds_every_other_reading():
    readings = values_of(hyperbola(30.0), hyperbola(24.0), hyperbola(45.0))
    value, low, high = of(closure_constants(curve_of(), 0.25, readings, None), "k_ni")
    assert value == pytest.approx(30.0, rel=1e-2)
    assert low < 24.0
    assert 45.0 < high < 46.0


def test_the_interval_holds_the_spread_over_registrations_where_that_is_wider():
    motions = values_of(*(hyperbola(k) for k in (20.0, 25.0, 30.0, 35.0)))
    near = values_of(hyperbola(30.0), hyperbola(30.5))
    _, low, high = of(closure_constants(curve_of(), 0.25, near, motions), "k_ni")
    half = t_quantile(3) * np.std([20, 25, 30, 35], ddof=1)
    assert high - low == pytest.approx(2 * half, rel=0.05)


def test_a_constant_that_no_other_reading_has_is_unbounded():
    readings = values_of(hyperbola(30.0), hyperbola(24.0), sound=[[True] * 9, [False] * 9])
    value, low, high = of(closure_constants(curve_of(), 0.25, readings, None), "k_ni")
    assert np.isfinite(value)
    assert low == 0
    assert high == np.inf


@pytest.mark.parametrize(
    ("change", "is_determined"), [(np.nan, True), (0.01, True), (0.05, False), (-0.02, False)]
)
def test_k_ni_that_another_grid_moves_out_of_its_interval_is_undetermined(change, is_determined):
    """The fit's interval is -1 to +2 %; without a solve at twice the spacing it decides."""
    constants = closure_constants(curve_of(change=change), 0.25, None, None)
    assert constants["k_ni_determined"][1] == is_determined
    assert ("twice the spacing" in constants["k_ni_reason"][1]) != is_determined
    # Readings that differ by more hold the change of the grid.
    readings = values_of(hyperbola(30.0), hyperbola(24.0))
    assert closure_constants(curve_of(change=change), 0.25, readings, None)["k_ni_determined"][1]
    told = closure_constants(curve_of(change=change, reason="too few states"), 0.25, None, None)
    assert told["k_ni_reason"][1] == "too few states"
    assert not told["k_ni_determined"][1]
