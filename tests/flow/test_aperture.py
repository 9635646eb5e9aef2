"""Statistics of apertures and the empirical laws of the hydraulic aperture."""

import numpy as np
import pytest

from fractalcontact.flow.aperture import (
    barton_aperture,
    permeability_law,
    reynolds_gradient,
    rms_slope,
    zimmerman_bodvarsson_aperture,
)
from fractalcontact.flow.cubic_law import flow_of
from fractalcontact.flow.joint_flow import path_pressures
from fractalcontact.flow.network import NO_PATH


def test_the_slope_of_a_plane_is_its_gradient_and_contact_counts_for_nothing():
    y, x = np.mgrid[:20, :30]
    gap = 1 + 0.3 * 0.1 * x + 0.4 * 0.2 * y
    assert rms_slope(gap, (0.2, 0.1)) == pytest.approx(0.5, rel=0.02)
    gap[5:15, 10:20] = 0
    assert rms_slope(gap, (0.2, 0.1)) == pytest.approx(0.5, rel=0.02)
    assert np.isnan(rms_slope(np.zeros((4, 4)), (1, 1)))


def test_laws_of_smooth_plates_give_their_gap():
    assert zimmerman_bodvarsson_aperture(0.1, 0.0, 0.0) == pytest.approx(0.1)
    assert zimmerman_bodvarsson_aperture(0.1, 0.05, 0.1) == pytest.approx(
        0.1 * np.cbrt(0.625 * 0.8)
    )
    assert np.isnan(
        zimmerman_bodvarsson_aperture([0.1, 0.1, 0.0], [0.09, 0.0, 0.0], [0, 0.5, 1])
    ).all()


def test_barton_s_law_is_in_micrometres_and_ends_at_the_mechanical_aperture():
    found = barton_aperture([0.1, 1.0], 10.0)
    assert found[0] == pytest.approx(1e-3 * 100**2 / 10**2.5)
    assert np.isnan(found[1])
    assert np.isnan(barton_aperture([0.1], np.nan)).all()


def test_water_reaches_a_reynolds_number_of_one_at_ten_kilopascals_a_metre():
    # Parallel plates 0.1 mm apart: rho T grad p / mu^2 = 1.
    gradient = reynolds_gradient(0.1**3 / 12)
    assert 1e9 * gradient == pytest.approx(12.07e3, rel=1e-3)  # Pa/m
    assert np.isnan(reynolds_gradient(0.0))


def test_pressures_of_percolation_lie_between_loads():
    pressure = np.array([1.0, 2.0, 5.0, 10.0])
    assert path_pressures(pressure, np.array([3.0, 1.0, 0.0, 0.0]), np.nan) == (2.0, 5.0)
    opened, closed = path_pressures(pressure, np.array([3.0, 1.0, np.nan, 1e-9]), np.nan)
    assert opened == 10
    assert np.isnan(closed)


def test_a_closed_gap_says_why_nothing_flows():
    flow = flow_of(np.zeros((4, 4)), (1.0, 1.0), "x")
    assert flow.transmissivity == 0
    assert flow.reason == NO_PATH


PRESSURE, K_0, ALPHA = np.array([0.5, 1.0, 5.0, 10.0, 25.0]), 2e-4, 0.04
EVERY = np.ones(5, bool)


def falling(k_0=K_0, alpha=ALPHA):
    """T of a joint whose permeability falls exponentially with the pressure."""
    return (12 * k_0 * np.exp(-alpha * PRESSURE)) ** 1.5 / 12


def test_a_permeability_that_falls_exponentially_has_its_constants():
    """k = k_0 exp(-alpha sigma) on each branch; two loads give no law."""
    found = permeability_law(PRESSURE, [falling(), falling(K_0 / 2, ALPHA / 4)], EVERY)
    np.testing.assert_allclose(found["permeability_k_0"].value, [K_0, K_0 / 2])
    np.testing.assert_allclose(found["permeability_alpha"].value, [ALPHA, ALPHA / 4])
    np.testing.assert_allclose(found["permeability_alpha"].low, [ALPHA, ALPHA / 4], rtol=1e-6)
    scattered = permeability_law(PRESSURE, [falling() * np.array([1, 1, 1.2, 0.8, 1.1])], EVERY)
    alpha_of = scattered["permeability_alpha"]
    assert alpha_of.low < ALPHA < alpha_of.high
    too_few = permeability_law(PRESSURE, [falling()], EVERY & (PRESSURE < 2))
    assert not too_few["permeability_alpha"].known.any()
    assert np.isnan(too_few["permeability_pressure_low"])


def test_all_branches_are_fitted_over_the_loads_that_may_be_and_at_which_water_passes():
    loaded, reloaded = falling(), falling(K_0 / 2)
    loaded[0] *= 9
    loaded[1], reloaded[4] = 0, np.nan
    may_fit = PRESSURE > 0.7
    with_more = np.append(PRESSURE, 15.0), np.append(may_fit, True)
    flows = [np.append(of, 10.0) for of in (loaded, reloaded)]
    for of, k_0 in zip(flows, (K_0, K_0 / 2), strict=True):
        of[-1] = (12 * k_0 * np.exp(-ALPHA * 15)) ** 1.5 / 12
    found = permeability_law(with_more[0], flows, with_more[1])
    ends = [found[f"permeability_pressure_{end}"] for end in ("low", "high")]
    assert ends == [5.0, 15.0]
    np.testing.assert_allclose(found["permeability_k_0"].value, [K_0, K_0 / 2])


def test_a_branch_that_is_not_valid_has_no_law_and_keeps_none_of_the_others_from_it():
    found = permeability_law(PRESSURE, [falling(), np.full(5, np.nan)], EVERY)
    assert found["permeability_k_0"].known.tolist() == [True, False]
    assert found["permeability_pressure_high"] == PRESSURE[-1]
    closed = permeability_law(PRESSURE, [np.zeros(5)], EVERY)
    assert not closed["permeability_k_0"].known.any()
