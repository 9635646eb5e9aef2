"""Bulk settlement, closure curves and dilatancy."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact import HalfSpace, solve_contact
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.settings import Solver
from fractalcontact.core.verdicts import ABOVE, BELOW, WITHIN
from fractalcontact.core.window import window_sides
from fractalcontact.joint.joint import composite_topography, describe_joint
from fractalcontact.joint.openings import prefractal_openings
from fractalcontact.laws.closure import (
    FLUSH_FACES,
    FULL_CONTACT,
    bulk_settlement,
    closure_curves,
    elastic_dilatancy,
    full_contact_warning,
    interface_stiffness,
    stiffness_reason,
)
from fractalcontact.laws.conductance import beside_theory
from fractalcontact.laws.load_curve import closure_at_force, left_out_misses
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.states import OFFSETS, REASONS, STATE_VARIABLES, combine
from fractalcontact.states.sweep import contact_states
from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.slope import ALL_YIELDED, FEW_CELLS


def test_bulk_settlement_of_a_square():
    exact = (4 * np.log(1 + np.sqrt(2)) - 4 / 3 * (np.sqrt(2) - 1)) / np.pi
    assert bulk_settlement(100.0, 1e4, 20, 20) == pytest.approx(exact * 100 / (1e4 * 20), rel=1e-12)


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


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [(0.9, 0.97, WITHIN), (0.5, 0.6, BELOW), (1.2, 1.4, ABOVE), (np.nan, np.nan, "")],
)
def test_exponents_of_conductance_are_judged_by_their_intervals(low, high, words):
    exponent = Estimate(np.array([(low + high) / 2]), np.array([low]), np.array([high]))
    assert beside_theory(exponent) == [words]


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


def test_elastic_dilatancy_is_separation_and_bulk_settlement():
    # Eq. 4 in its other form: what the highest node decides cancels.
    _, joint, curves = slid_joint([0, 3, 6], loads=["0.1 MPa", "1 MPa", "10 MPa", "100 MPa"])
    dilatancy = elastic_dilatancy(curves, joint)
    other = dilatancy["separation"] + curves["bulk_settlement"]
    difference = other - dilatancy["elastic_dilatancy"]
    np.testing.assert_allclose(difference.isel(offset=slice(1, None)), 0, atol=1e-15)
    # Flush faces have nothing to close: a punch settles less than its pressure spread evenly.
    assert (difference.isel(offset=0) > 0).all()
    assert (dilatancy["separation_error"] == curves["closure_error"].squeeze()).all()


def test_separation_of_prefractals_is_counted_from_one_datum():
    specimen, joint, curves = slid_joint([0, 3, 6], ["1 MPa", "10 MPa"], resolutions=[1, 2, 4])
    openings = prefractal_openings(specimen, joint, [1, 2, 4])
    for j, cells in enumerate((0, 3, 6)):
        composite = composite_topography(specimen, "E", cells)
        for k in (1, 2, 4):
            highest = composite[::k, ::k].max()
            assert openings.sel(resolution=k).values[0, j] == pytest.approx(highest, abs=1e-12)
    again = closure_curves(states_of(curves), (4.8, 4.8), 2e4, openings=openings)
    expected = openings.values[..., np.newaxis] - again["closure"]
    np.testing.assert_allclose(again["separation"], expected)
    # Without openings only the scan's own resolution has a separation.
    assert np.isfinite(curves["separation"].sel(resolution=1)).all()
    assert np.isnan(curves["separation"].sel(resolution=[2, 4])).all()
    np.testing.assert_array_equal(
        curves["separation"].sel(resolution=1), again["separation"].sel(resolution=1)
    )


def test_a_spike_moves_first_contact_but_not_separation_nor_seated_closure():
    heights = self_affine((64, 64), 0.1, 0.8, seed=2, rms=0.1)
    spiked = heights.copy()
    spiked[20, 30] = heights.max() + 0.05
    plain, other = (
        curves_of(surface, [500, 1e3, 2e3, 5e3, 1e4]).squeeze() for surface in (heights, spiked)
    )
    moved = abs(other["interface_closure"] - plain["interface_closure"]).isel(normal_force=-1)
    assert moved > 0.045
    heavy = slice(3, None)
    for name in ("seated_closure", "separation"):
        change = abs(other[name] - plain[name]).isel(normal_force=heavy)
        assert (change < 0.15 * moved).all(), name
    assert (plain["separation"] < heights.max() - heights.mean()).all()
    assert plain["separation"][0] > 0


def test_seated_closure_begins_at_ten_nodes_or_where_the_study_says():
    heights = self_affine((64, 64), 0.1, 0.8, seed=2, rms=0.1)
    curves = curves_of(heights, [1, 30, 300, 1e3, 3e3])
    curve = curves.squeeze()
    assert curve["nodes"].values[0] < 10 <= curve["nodes"].values[2]
    np.testing.assert_array_equal(curve["resolved"], curve["nodes"] >= 10)
    first = int(np.argmax(curve["resolved"].values))
    assert curve["seating_pressure"] == curve["nominal_pressure"][first]
    assert np.isnan(curve["seated_closure"][:first]).all()
    w = curve["interface_closure"].values
    np.testing.assert_allclose(curve["seated_closure"][first:], w[first:] - w[first])
    assert curve["seated_closure_error"][first] == 0
    errors = curve["closure_error"].values
    np.testing.assert_allclose(
        curve["seated_closure_error"][first + 1 :], errors[first + 1 :] + errors[first]
    )
    # The first load from the study's own pressure on: that itself, or the next.
    for pressure in (1e3 / 6.4**2, 400 / 6.4**2):
        stated = closure_curves(states_of(curves), (6.4, 6.4), 2e4, seating_pressure=pressure)
        stated = stated.squeeze()
        assert stated["seating_pressure"].item() == pytest.approx(1e3 / 6.4**2)
    np.testing.assert_allclose(stated["seated_closure"][3:], w[3:] - w[3])
    assert np.isnan(stated["seated_closure"][:3]).all()


def test_the_seat_is_the_lightest_load_mostly_on_sound_cells():
    heights = self_affine((64, 64), 0.1, 0.8, seed=2, rms=0.1)
    states = states_of(curves_of(heights, [300, 1e3, 3e3, 1e4]))
    for share, first in (([0.5, 0, 0, 0], 0), ([1, 0.51, 0.5, 0.1], 2), ([0, 1, 0, 0], 0)):
        states["suspect_load_share"][...] = share
        curve = closure_curves(states, (6.4, 6.4), 2e4).squeeze()
        assert curve["seating_pressure"] == curve["nominal_pressure"][first]
        assert curve["seated_closure"][first] == 0
    states["suspect_load_share"][...] = 0.6
    none = closure_curves(states, (6.4, 6.4), 2e4).squeeze()
    assert np.isnan(none["seating_pressure"])
    assert "sound cells" in none["no_common_seat"].item()
    assert not none["hyperbola_k_ni_determined"]


def test_closures_of_all_offsets_count_from_one_pressure():
    """The largest of their own seats: there the closure is 0, beyond it what it is more."""
    _, _, curves = slid_joint([1, 4, 16], ["10 MPa", "40 MPa", "100 MPa", "250 MPa"], (1, 2))
    pressure = curves["nominal_pressure"]
    seats, common = curves["seating_pressure"], curves["common_seating_pressure"]
    own = seats.sel(resolution=1).values.ravel()
    assert own.min() < own.max()
    np.testing.assert_array_equal(common, seats.max("offset"))
    closing, seated = curves["interface_closure"], curves["closure_from_common_seat"]
    there, beyond = abs(pressure - common) < 1e-9 * common, pressure > (1 - 1e-9) * common
    at_seat = closing.where(there).max("normal_force")
    expected = (closing - at_seat).where(beyond).transpose(*seated.dims)
    np.testing.assert_array_equal(seated, expected)
    error = curves["closure_from_common_seat_error"]
    assert (error.where(there, 0) == 0).all()
    np.testing.assert_array_equal(np.isfinite(error), np.isfinite(seated))
    # Where the offset decides the common seat, both closures are one.
    latest = curves.isel(offset=int(own.argmax()), resolution=0)
    for end in ("", "_error"):
        np.testing.assert_array_equal(
            latest[f"closure_from_common_seat{end}"], latest[f"seated_closure{end}"]
        )
    assert (curves["no_common_seat"] == "").all()


def test_an_offset_whose_state_at_the_common_seat_is_missing_has_no_closure_from_there():
    _, _, curves = slid_joint([1, 16], ["10 MPa", "40 MPa", "100 MPa", "250 MPa"])
    common = curves["common_seating_pressure"].item()
    assert curves["seating_pressure"].values.ravel()[0] < common
    states, offset = states_of(curves), curves["offset"]
    lost = (offset == offset[0]) & (abs(curves["nominal_pressure"] - common) < 1e-9 * common)
    states["closure"] = states["closure"].where(~lost)
    again = closure_curves(states, (4.8, 4.8), 2e4)
    assert again["common_seating_pressure"].item() == pytest.approx(common)
    missing, other = (again["closure_from_common_seat"].isel(offset=i) for i in (0, 1))
    assert np.isnan(missing).all()
    assert np.isnan(again["closure_from_common_seat_error"].isel(offset=0)).all()
    assert np.isfinite(other).any()


def test_a_curve_without_resolved_states_is_not_seated():
    curve = curves_of(self_affine((64, 64), 0.1, 0.8, seed=2, rms=0.1), [0.01, 0.02]).squeeze()
    assert not curve["resolved"].any()
    assert np.isnan(curve["seating_pressure"])
    assert np.isnan(curve["seated_closure"]).all()
    assert np.isnan(curve["common_seating_pressure"])
    assert np.isnan(curve["closure_from_common_seat"]).all()
    assert "10 nodes" in curve["no_common_seat"].item()


def test_areas_are_fractions_of_the_window_and_flagged_where_few_nodes_touch():
    curve = curves_of(self_affine((64, 64), 0.1, 0.8, seed=2, rms=0.1), [3, 300, 3e3]).squeeze()
    np.testing.assert_allclose(curve["area_corrected_share"] * 6.4**2, curve["area_corrected"])
    assert (curve["area_corrected_share"] < curve["area_share"]).all()
    np.testing.assert_array_equal(curve["area_corrected_resolved"], curve["nodes"] >= 30)
    assert 0 < curve["area_corrected_resolved"].sum() < 3


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
    curves = (xr.DataArray(values, dims="normal_force") for values in (closure, stiffness))
    missed = abs(left_out_misses(force, *curves).values) / closure
    for wanted in np.geomspace(force[1], force[-2], 8):
        by_force = solve_contact(composite, space, force=wanted).closure
        read = closure_at_force(wanted, force, closure, stiffness)
        after = np.searchsorted(force, wanted, side="right")
        error = read * np.nanmax(missed[after - 1 : after + 1])
        rounding = 1e-6 * by_force  # and the tolerance of the solver
        assert abs(read - by_force) <= error + rounding
        assert error < 0.05 * by_force


def test_beyond_the_curve_nothing_is_read():
    assert np.isnan(closure_at_force(10, [1, 2, 3], [0.1, 0.2, 0.3], [10, 10, 10]))


def test_a_closure_is_read_beside_states_without_a_stiffness():
    """On a power law, which its secants tell as its slopes do."""
    force = np.geomspace(1, 1000, 10)
    closure = 0.1 * force**0.3
    stiffness = force / (0.3 * closure)
    stiffness[[0, 4, 5, 9]] = np.nan
    for wanted in (1.5, 30.0, 47.0, 800.0):
        read = closure_at_force(wanted, force, closure, stiffness)
        assert read == pytest.approx(0.1 * wanted**0.3, rel=1e-9)


def test_what_a_left_out_state_misses_is_in_the_atlas():
    _, joint, curves = slid_joint([4], loads=[f"{p} MPa" for p in (0.3, 1.1, 4, 13)])
    missed = elastic_dilatancy(curves, joint)["left_out_error"].squeeze().values
    assert np.isnan(missed[[0, -1]]).all()
    finest = curves.squeeze()
    read = closure_at_force(
        *(finest[name].values[j] for name, j in (("normal_force", 1),)),
        *(finest[name].values[[0, 2, 3]] for name in ("normal_force", "closure", "stiffness")),
    )
    assert missed[1] == pytest.approx(abs(read - finest["closure"].values[1]), rel=1e-9)


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
    openings = prefractal_openings(specimen, describe_joint(specimen, settings), [1])
    sides = window_sides(specimen)
    return closure_curves(combine([states]), sides, 2e4, openings=openings)


def states_of(curves):
    """The states that curves were computed from, but for the reasons of missing stiffnesses."""
    reasons = {name: xr.full_like(curves["closure"], "", object) for name in REASONS}
    return curves.assign(reasons)[[*STATE_VARIABLES, *OFFSETS]]


def slid_joint(cells, loads, resolutions=(1,)):
    """A matching joint slid by some cells: specimen, joint and closure curves."""
    heights = self_affine((96, 96), 0.1, 0.8, seed=5, rms=0.15, roll_off=1.5)
    specimen = make_specimen(scan_of(heights), window=4.8, name="made")
    offsets = [f"{n * 0.1:g} mm" for n in cells]
    study = SETTINGS["defaults"] | {"offsets": offsets, "loads": loads}
    study |= {"resolutions": list(resolutions)}
    settings = resolve_settings(SETTINGS | {"defaults": study}, None, {}, "test")
    states = contact_states(JointLoading(specimen, "E", cells, settings, SOLVER), resolutions)
    curves = closure_curves(combine([states]), window_sides(specimen), 2e4)
    return specimen, describe_joint(specimen, settings), curves


SOLVER = Solver(1e-7, "love", None)


def test_a_missing_stiffness_has_its_reason_and_none_is_negative():
    total = xr.DataArray([1.0, 3.0, np.nan, 1.0], dims="state")
    flush = xr.DataArray([False, False, False, True], dims="state")
    found = interface_stiffness(1 / total, 1 / 2.0).where(~flush)
    np.testing.assert_allclose(found, [2.0, np.nan, np.nan, np.nan])
    no_total = xr.DataArray(["", "", ALL_YIELDED, FEW_CELLS], dims="state")
    reasons = stiffness_reason(found, total, flush, no_total).values.tolist()
    assert reasons == ["", FULL_CONTACT, ALL_YIELDED, FLUSH_FACES]


def test_the_closure_of_polished_faces_in_full_contact_is_undetermined():
    """They settle like a rigid punch, by less than w_b: the difference says nothing of them."""
    heights = self_affine((32, 32), 0.1, 0.8, seed=3, rms=5e-5)
    curves = curves_of(heights, [1.0, 1e4])
    light, full = curves["interface_closure"].squeeze().values
    assert curves["area_share"].values.squeeze()[1] == 1
    # The closure of the whole is known as ever, and lies below the settlement by 8 %.
    difference = float(curves["closure"].squeeze()[1] - curves["bulk_settlement"][1])
    assert -0.09 < difference * 2e4 * 3.2 / 1e4 < -0.06
    assert np.isnan(full)
    assert 0 < light <= heights.max() - heights.min()
    assert np.isnan(curves["interface_stiffness"].squeeze()[1])
    assert curves["interface_stiffness_reason"].squeeze().values.tolist() == ["", FULL_CONTACT]
    assert "so full in 1 of 2 states" in full_contact_warning(curves)
    rough = curves_of(self_affine((32, 32), 0.1, 0.8, seed=3, rms=0.05), [1.0, 100.0])
    assert (rough["interface_closure"] > 0).all()
    assert full_contact_warning(rough) == ""
