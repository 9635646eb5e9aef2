"""Bulk settlement, hyperbola and dilatancy."""

import numpy as np
import pytest
import xarray as xr
from ensembles import ensemble

from fractalcontact import HalfSpace, solve_contact
from fractalcontact.mechanics.closure import (
    bulk_settlement,
    closure_curves,
    elastic_dilatancy,
    fit_hyperbola,
)
from fractalcontact.mechanics.joint import describe_joint
from fractalcontact.mechanics.load_curve import closure_at_force
from fractalcontact.mechanics.loading import JointLoading
from fractalcontact.mechanics.states import combine
from fractalcontact.mechanics.sweep import contact_states
from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.specimen import make_specimen, window_sides
from fractalcontact.surface.synthesis import self_affine


def test_bulk_settlement_of_a_square():
    exact = (4 * np.log(1 + np.sqrt(2)) - 4 / 3 * (np.sqrt(2) - 1)) / np.pi
    assert bulk_settlement(100.0, 1e4, 20, 20) == pytest.approx(exact * 100 / (1e4 * 20), rel=1e-12)


def test_a_hyperbola_is_found_again_exactly():
    w = np.linspace(0.01, 0.35, 8)
    sigma = 30 * w / (1 - w / 0.4)
    fit = fit_hyperbola(sigma, w)
    assert (fit.k_ni, fit.w_m) == pytest.approx((30, 0.4), rel=1e-6)
    assert fit.misfit < 1e-6
    assert fit.reason == ""


def test_the_intervals_hold_the_truth_in_95_of_100_draws():
    rng = np.random.default_rng(1)
    w = np.linspace(0.02, 0.35, 12)
    sigma = 30 * w / (1 - w / 0.4)
    draws = ensemble("fitted hyperbolas")
    fits = [fit_hyperbola(sigma, w + rng.normal(0, 0.004, w.size)) for _ in range(draws)]
    of_k = sum(fit.k_ni_low <= 30 <= fit.k_ni_high for fit in fits)
    of_wm = sum(fit.w_m_low <= 0.4 <= fit.w_m_high for fit in fits)
    # At most three standard deviations of the count below: 930 of 1000.
    fewest = 0.95 * draws - 3 * np.sqrt(0.95 * 0.05 * draws)
    assert min(of_k, of_wm) >= fewest, (of_k, of_wm)


def test_a_straight_line_has_no_asymptote():
    sigma = np.linspace(1, 10, 8)
    fit = fit_hyperbola(sigma, sigma / 50 * (1 + 1e-3 * np.sin(sigma)))
    assert np.isnan(fit.w_m) or fit.w_m_high > 2 * sigma.max() / 50


def test_too_few_points_give_a_reason():
    fit = fit_hyperbola([1, 2, 3], [0.1, 0.15, -1])
    assert np.isnan(fit.k_ni)
    assert "needed" in fit.reason


def test_interface_compliance_is_what_the_bulk_leaves():
    heights = self_affine((64, 64), 0.1, 0.8, seed=2, rms=0.1)
    space = HalfSpace((64, 64), (0.1, 0.1), 2e4)
    curves = curves_of(heights, [1e3, 1.001e3, 5e3])
    state = solve_contact(heights, space, force=1e3, rtol=1e-8)
    w_int, sigma = curves["interface_closure"].squeeze(), curves["nominal_pressure"]
    measured = float((sigma[1] - sigma[0]) / (w_int[1] - w_int[0]))
    assert float(curves["interface_stiffness"].squeeze()[0]) == pytest.approx(measured, rel=2e-3)
    assert float(curves["closure"].squeeze()[0]) == pytest.approx(state.closure, rel=1e-5)


def test_conductance_of_hertzian_contact():
    # dF/dw = 2 a E*: the whole has the conductance of a circular spot, k 2 a.
    y, x = np.meshgrid(*[(np.arange(96) - 47.5) * 0.1] * 2, indexing="ij")
    forces, radius = np.array([100, 200, 400, 800.0]), 40
    curves = curves_of(-(x**2 + y**2) / (2 * radius), forces)
    spot = (0.75 * forces * radius / 2e4) ** (1 / 3)
    area = 9.6**2
    of_window = bulk_settlement(forces, 2e4, 9.6, 9.6) * area / forces  # mm/MPa
    expected = 1 / (area / (2 * spot) - 2e4 * of_window)
    assert curves["conductance"].values.squeeze() == pytest.approx(expected, rel=0.05)
    exponent = curves["conductance_exponent"].item()
    assert exponent == pytest.approx(np.polyfit(np.log(forces), np.log(expected), 1)[0], abs=0.02)
    low, high = (curves[f"conductance_exponent_{end}"].item() for end in ("low", "high"))
    assert low < exponent < high


def test_flush_faces_do_not_close_nor_open():
    _, joint, curves = slid_joint([0, 3], loads=["0.1 MPa", "1 MPa", "10 MPa", "100 MPa"])
    mated = curves.isel(offset=0)
    assert (mated["area_share"] == 1).all()
    assert (mated["interface_closure"] == 0).all()
    assert np.isnan(mated["interface_stiffness"]).all()
    assert np.isnan(mated["hyperbola_k_ni"]).all()
    opened = elastic_dilatancy(curves, joint)["elastic_dilatancy"]
    assert (opened.isel(offset=0) == 0).all()
    assert (curves.isel(offset=1)["area_share"] < 1).all()


def test_dilatancy_by_force_and_by_interpolation_agree_within_the_error_stated():
    composite = self_affine((96, 96), 0.1, 0.8, seed=5, rms=0.15, roll_off=1.5)
    space = HalfSpace((96, 96), (0.1, 0.1), 2e4)
    states, state = [], None
    for w in np.geomspace(0.003, 0.4, 14):
        state = solve_contact(composite, space, closure=w, start=state)
        states.append(state)
    force, closure, stiffness = (
        np.array([getattr(s, name) for s in states]) for name in ("force", "closure", "stiffness")
    )
    for wanted in np.geomspace(force[1], force[-2], 8):
        by_force = solve_contact(composite, space, force=wanted).closure
        read = closure_at_force(wanted, force, closure, stiffness)
        rounding = 1e-6 * by_force  # and the tolerance of the solver
        assert abs(read.closure - by_force) <= read.error + rounding
        assert read.error < 0.05 * by_force


def test_beyond_the_curve_nothing_is_read():
    assert np.isnan(closure_at_force(10, [1, 2, 3], [0.1, 0.2, 0.3], [10, 10, 10])).all()


def test_what_a_left_out_state_misses_is_in_the_atlas():
    _, joint, curves = slid_joint([4], loads=[f"{p} MPa" for p in (0.3, 1.1, 4, 13)])
    missed = elastic_dilatancy(curves, joint)["left_out_error"].squeeze().values
    assert np.isnan(missed[[0, -1]]).all()
    finest = curves.squeeze()
    read = closure_at_force(
        *(finest[name].values[j] for name, j in (("normal_force", 1),)),
        *(finest[name].values[[0, 2, 3]] for name in ("normal_force", "closure", "stiffness")),
    )
    assert missed[1] == pytest.approx(abs(read.closure - finest["closure"].values[1]), rel=1e-9)


SETTINGS = {
    "materials": {"rock": {"modulus": "38.4 GPa", "poisson": 0.2}},
    "defaults": {"material": "rock", "resolutions": [1], "contact_directions": ["E"]},
}


def scan_of(heights):
    coords = {"y": np.arange(len(heights)) * 0.1, "x": np.arange(heights.shape[1]) * 0.1}
    attrs = {"spacing_x": 0.1, "spacing_y": 0.1}
    return xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)


def curves_of(heights, forces):
    """Closure curves of a surface against a plane."""
    specimen = make_specimen(scan_of(heights), opposite="flat", name="made")
    specimen["lower"].values[...] = heights  # as made, not levelled
    study = SETTINGS["defaults"] | {"opposite": "flat", "loads": [f"{f} N" for f in forces]}
    settings = resolve_settings(SETTINGS | {"defaults": study}, None, {}, "test")
    states = contact_states(JointLoading(specimen, "none", [0], settings, SOLVER), [1])
    return closure_curves(combine([states]), window_sides(specimen), 2e4)


def slid_joint(cells, loads):
    """A matching joint slid by some cells: specimen, joint and closure curves."""
    heights = self_affine((96, 96), 0.1, 0.8, seed=5, rms=0.15, roll_off=1.5)
    specimen = make_specimen(scan_of(heights), window=4.8, name="made")
    offsets = [f"{n * 0.1:g} mm" for n in cells]
    study = SETTINGS["defaults"] | {"offsets": offsets, "loads": loads}
    settings = resolve_settings(SETTINGS | {"defaults": study}, None, {}, "test")
    states = contact_states(JointLoading(specimen, "E", cells, settings, SOLVER), [1])
    curves = closure_curves(combine([states]), window_sides(specimen), 2e4)
    return specimen, describe_joint(specimen, settings), curves


SOLVER = {"rtol": 1e-7, "kernel": "love"}
