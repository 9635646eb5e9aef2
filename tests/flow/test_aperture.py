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


def test_a_permeability_that_falls_exponentially_has_its_constants():
    """k = k_0 exp(-alpha sigma); states without a passage are left out, two give no law."""
    pressure, k_0, alpha = np.array([0.5, 1.0, 5.0, 10.0, 25.0]), 2e-4, 0.04
    k = k_0 * np.exp(-alpha * pressure)
    transmissivity = (12 * k) ** 1.5 / 12
    transmissivity[1] = 0
    found = permeability_law(pressure, transmissivity)
    assert found["permeability_k_0"].value == pytest.approx(k_0)
    assert found["permeability_alpha"].value == pytest.approx(alpha)
    assert found["permeability_alpha"].low == pytest.approx(alpha, rel=1e-6)
    scattered = permeability_law(pressure, transmissivity * np.array([1, 1, 1.2, 0.8, 1.1]))
    alpha_of = scattered["permeability_alpha"]
    assert alpha_of.low < alpha < alpha_of.high
    assert not permeability_law(pressure[:3], transmissivity[:3])["permeability_alpha"].known
