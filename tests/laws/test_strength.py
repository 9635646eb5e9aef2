"""Dilatancy angle, shear strength, and Barton and Bandis' law."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.intervals import t_quantile
from fractalcontact.core.limits import JRC_RANGE, LARGEST_FRICTION_ANGLE
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.core.settings import Friction, Solver
from fractalcontact.core.window import nominal_area, window_sides
from fractalcontact.joint.barton import barton_strength, joint_roughness, scaled_joint
from fractalcontact.joint.joint import describe_joint
from fractalcontact.joint.jrc import FITS, profile_roughness
from fractalcontact.laws.closure import closure_curves, elastic_dilatancy
from fractalcontact.laws.strength import (
    ABOVE_SCALE,
    BARTON_TRUNCATED,
    HALF_TOUCHES,
    OF_WINDOW,
    OFF_LENGTHS,
    OWN,
    READ,
    TRUNCATED,
    UNSCALED,
    WINDOW,
    _by_barton,
    angles_with_errors,
    dilatancy_angle,
    from_flush,
    joint_strength,
    judged_strengths,
    peak,
    residual,
    shear_strength,
)
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.states import combine
from fractalcontact.states.sweep import contact_states
from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1
SOLVER = Solver(1e-6, "love", None)


def scan(heights, spacing=SPACING):
    coordinates = [spacing * (np.arange(n) + 0.5) for n in heights.shape]
    attrs = {"spacing_x": spacing, "spacing_y": spacing, "source": "made", "sha256": "0" * 64}
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


def settings(offsets, directions=("W",), **material):
    stated = {"modulus": "20 GPa", "poisson": 0.2}
    study = {
        "materials": {},
        "defaults": {
            "material": stated,
            "directions": list(directions),
            "offsets": [f"{v} mm" for v in offsets],
            "loads": ["0.5 MPa", "5 MPa", "25 MPa"],
            "resolutions": [1],
        },
    }
    chosen = resolve_settings(study, "made", {}, "made")
    strength = {"basic_friction_angle": 30.0, "joint_wall_strength": 100.0} | material
    return replace(chosen, material=replace(chosen.material, **strength))


def pressed(specimen, chosen):
    """Dilatancy and joint of a specimen."""
    joint = describe_joint(specimen, chosen)
    states = combine(
        [
            contact_states(JointLoading.of_joint(specimen, joint, d, chosen, SOLVER), [1])
            for d in chosen.contact_directions
        ]
    )
    curves = closure_curves(states, window_sides(specimen), chosen.material.e_star)
    return elastic_dilatancy(curves, joint), joint


def strength_of(specimen, chosen):
    dilatancy, joint = pressed(specimen, chosen)
    return joint_strength(dilatancy, joint, specimen, chosen)


def saw(cells, slope, period=16):
    """Ridges along y: triangles of that slope along x."""
    x = np.arange(cells) % period
    profile = slope * SPACING * np.minimum(x, period - x)
    return np.tile(profile, (cells, 1))


@pytest.fixture(scope="module")
def twin():
    return make_specimen(
        scan(self_affine((64, 64), SPACING, 0.8, rms=0.1, seed=5, roll_off=2)),
        window=3.2,
        reach=1.6,
        name="twin",
    )


OFFSETS = [0.1, 0.2, 0.4, 0.8, 1.0, 1.2, 1.6]


@pytest.fixture(scope="module")
def strength(twin):
    return strength_of(twin, settings(OFFSETS, ("W", "N")))


# Exact


@pytest.mark.parametrize("degrees", [-20.0, 0.0, 35.0])
def test_a_straight_climb_has_one_angle(degrees):
    v = np.array([0.0, 0.1, 0.4, 2.0])
    midpoint, angle = dilatancy_angle(v, np.tan(np.radians(degrees)) * v)
    np.testing.assert_allclose(angle, degrees, atol=1e-12)
    np.testing.assert_allclose(midpoint, [0.05, 0.25, 1.2])


def test_error_of_an_angle_is_that_of_its_ends_in_opposite_directions():
    v, delta, error = [0.0, 1.0, 2.0], [0.0, 0.5, 0.4], np.array([0.0, 0.01, 0.02])
    _, angle = dilatancy_angle(v, delta)
    *same, found = angles_with_errors(v, delta, error)
    np.testing.assert_array_equal(same[1], angle)
    reached = np.zeros(2)
    for signs in itertools.product((-1, 1), repeat=3):
        off = abs(dilatancy_angle(v, delta + signs * error)[1] - angle)
        assert (off <= found + 1e-12).all()
        reached = np.maximum(reached, off)
    np.testing.assert_allclose(reached, found)


def test_strength_is_coulombs_and_its_angle_is_held():
    tau, held = shear_strength(2.0, np.array([-5.0, 0.0, 45.0, 70.0, 95.0, np.nan]))
    steepest = 2 * np.tan(np.radians(LARGEST_FRICTION_ANGLE))
    np.testing.assert_allclose(tau, [0, 0, 2, steepest, steepest, np.nan])
    assert held.tolist() == [-1, 0, 0, 0, 1, 0]


def test_faces_that_match_start_flush_under_any_load():
    for offset in ([0.1, 0.3], [0.0, 0.1, 0.3]):
        dilatancy = np.full((len(offset), 2), 0.7)
        v, delta = from_flush(offset, dilatancy)
        assert v.tolist() == [0, 0.1, 0.3]
        assert delta.tolist() == [[0, 0], [0.7, 0.7], [0.7, 0.7]]


def test_a_saw_climbs_its_own_slope_and_takes_its_own_roughness():
    slope = 0.3
    specimen = make_specimen(scan(saw(64, slope)), window=3.2, reach=0.7, name="saw")
    found = strength_of(specimen, settings([0.1, 0.2, 0.3, 0.7], ("W",)))
    np.testing.assert_allclose(
        found["rigid_dilatancy_angle"], np.degrees(np.arctan(slope)), atol=0.2
    )
    z2 = found["z2"].sel(contact_direction="W", sampling="scan")
    assert float(z2) == pytest.approx(slope, rel=0.02)
    jrc = found["jrc"].sel(contact_direction="W", sampling="scan")
    assert float(jrc) == pytest.approx(32.2 + 32.47 * np.log10(float(z2)), rel=1e-12)


def test_fits_to_the_same_profiles_agree_on_profiles_of_that_roughness():
    """Seven regressions over Barton's ten profiles, whose Z2 lie between 0.1 and 0.45."""
    for z2 in (0.15, 0.25, 0.35):
        for step in (0.5, 1.0):
            found = [fit(z2) for of, fit in FITS.values() if of == step]
            assert np.ptp(found) < 2.0
    assert FITS["Tatone and Grasselli 2010, 0.5 mm"][1](0.25) == pytest.approx(12.2, abs=0.01)


def test_each_fit_of_the_roughness_takes_the_slope_over_its_own_step():
    found = profile_roughness(
        make_specimen(scan(saw(64, 0.3)), window=3.2, reach=0.7, name="saw"), "E"
    )
    for fit, (step, _) in FITS.items():
        one = found.sel(fit=fit)
        cells = round(step / 0.1)
        assert float(one["fit_step"]) == pytest.approx(0.1 * max(cells, 1))
        near = abs(max(cells, 1) * 0.1 / step - 1) <= 0.25
        assert np.isfinite(one["jrc_by_fit"]) == near
    half = found.sel(fit="Tse and Cruden 1979, 0.5 mm")
    same = found.sel(sampling="0.508 mm")
    assert float(half["jrc_by_fit"]) == pytest.approx(float(same["jrc"]))


def test_no_slope_along_the_ridges_and_hence_no_roughness_there():
    flat_along_y = make_specimen(scan(saw(64, 0.3)), window=3.2, reach=0.7, name="saw")
    along, across = (profile_roughness(flat_along_y, d) for d in "NE")
    assert (along["z2"] < 1e-12).all()
    assert float(across["z2"].sel(sampling="scan")) > 0.25
    back = profile_roughness(flat_along_y, "W")
    # A flank more lies on one side of the window: only what faces the sliding differs.
    profiles = [name for name in across if "grasselli" not in str(name)]
    xr.testing.assert_identical(across[profiles], back[profiles])


def test_peak_is_the_first_largest_and_passes_over_what_is_missing():
    value, where = peak([1, 2, 3], [[np.nan, np.nan], [5, np.nan], [5, np.nan]])
    np.testing.assert_array_equal(value, [5, np.nan])
    np.testing.assert_array_equal(where, [2, np.nan])
    assert np.isnan(peak(np.empty(0), np.empty((0, 3)))).all()


def test_residual_is_the_mean_beyond_half_of_the_largest_offset():
    mean = residual([1.0, 4.9, 5.0, 9.0], [[9.0], [9.0], [1.0], [3.0]], 10.0)
    assert (mean.value, mean.n) == (2, 2)
    assert mean.low < 1 < 3 < mean.high


# Against another way


def test_strength_follows_from_the_elastic_dilatancy(twin):
    chosen = settings(OFFSETS)
    dilatancy, joint = pressed(twin, chosen)
    found = joint_strength(dilatancy, joint, twin, chosen)
    for j, force in enumerate(dilatancy["normal_force"].values):
        delta = [0.0, *dilatancy["elastic_dilatancy"].values[0, :, j]]
        v = [0.0, *dilatancy["offset"].values]
        sigma = force / nominal_area(twin)
        for k in range(len(v) - 1):
            i = np.degrees(np.arctan((delta[k + 1] - delta[k]) / (v[k + 1] - v[k])))
            angle = min(max(30 + i, 0), LARGEST_FRICTION_ANGLE)
            tau = sigma * np.tan(np.radians(angle))
            assert found["dilatancy_angle"].values[0, k, j] == pytest.approx(i, abs=1e-9)
            assert found["shear_strength"].values[0, k, j] == pytest.approx(tau, rel=1e-9)
    tau = found["shear_strength"].values[0]
    np.testing.assert_array_equal(found["peak_strength"][0], tau.max(axis=0))
    late = found["interval"].values >= OFFSETS[-1] / 2
    np.testing.assert_allclose(found["residual_strength"][0], tau[late].mean(axis=0))
    assert (found["residual_n"] == late.sum()).all()


def test_bartons_law_is_that_of_the_theory_with_the_roughness_of_the_face(strength):
    one = strength.sel(contact_direction="W")
    jrc = one["jrc_used"].item()
    np.testing.assert_array_equal(
        one["barton_strength"], barton_strength(one["nominal_pressure"], 30.0, jrc, 100.0)
    )
    # The window of 3.2 mm is shorter than any joint that the law of scale was measured on.
    assert np.isnan(one["scaled_roughness"])
    assert one["barton_scaled_reason"].item() == OFF_LENGTHS
    assert np.isnan(one["barton_scaled_strength"]).all()


def test_no_law_is_scaled_beyond_bartons_roughness_and_lengths():
    stated = Friction(basic_friction_angle=30.0, joint_wall_strength=100.0)
    pressure = np.array([1.0, 10.0])
    for jrc, side, reason in (
        (15.0, 100.0, ""),
        (15.0, 400.0, ""),
        (16.0, 60.0, ""),  # the upper end of its JRC is above 20 at that length
        (15.0, 401.0, OFF_LENGTHS),
        (15.0, 3.2, OFF_LENGTHS),
        (19.0, 60.0, ABOVE_SCALE),
    ):
        law = _by_barton(Estimate(jrc, jrc - 2, jrc + 2), stated, side, pressure)
        assert law["barton_scaled_reason"] == reason
        scaled = law["barton_scaled_strength"]
        assert np.isfinite(law["scaled_roughness"]) == (not reason)
        assert np.isfinite(scaled.value).all() == (not reason)
        if not reason:
            by_law = barton_strength(pressure, 30.0, *scaled_joint(jrc, 100.0, side))
            np.testing.assert_array_equal(scaled.value, by_law)
            assert (scaled.low < scaled.value).all()
            assert (scaled.value < scaled.high).all()
        # The law without scale needs no length, and its interval is that of the JRC.
        own = law["barton_strength"]
        for end, of in zip(own.ends, (jrc, jrc - 2, jrc + 2), strict=True):
            np.testing.assert_array_equal(end, barton_strength(pressure, 30.0, of, 100.0))


def test_a_strength_at_the_cut_off_of_bartons_law_is_a_bound_and_no_result():
    """phi_b + JRC log10(JCS/sigma): 79.5 degrees at 0.5 MPa, 53.5 at 10 MPa."""
    stated = Friction(basic_friction_angle=30.0, joint_wall_strength=150.0)
    law = _by_barton(Estimate(20.0, 18.0, 20.0), stated, 100.0, np.array([0.5, 10.0]))
    steepest = 0.5 * np.tan(np.radians(70))
    for name in ("barton_strength", "barton_scaled_strength"):
        assert law[name].value[0] == pytest.approx(steepest)
        assert law[f"{name}_valid"].tolist() == [False, True]
        assert law[f"{name}_reason"].tolist() == [BARTON_TRUNCATED, ""]
    unknown = Friction(basic_friction_angle=np.nan, joint_wall_strength=150.0)
    assert _by_barton(Estimate(20.0), unknown, 100.0, np.array([0.5]))["barton_strength_valid"]


def test_blocks_have_a_strength_by_each_rule_that_holds_for_their_length(twin):
    chosen = replace(settings([0.2, 0.8]), block_lengths=[100.0, 200.0, 1000.0])
    found = strength_of(twin, chosen).squeeze("contact_direction")
    assert found["block_length"].values.tolist() == [100.0, 200.0, 1000.0]
    reasons = found["block_reason"]
    assert reasons.isel(normal_force=-1).values.tolist() == [
        [OF_WINDOW] * 3,
        [OF_WINDOW] * 3,
        ["", UNSCALED, UNSCALED],
        ["", "", OFF_LENGTHS],
    ]
    np.testing.assert_array_equal(np.isfinite(found["block_strength"]), reasons == "")
    pressure, jrc = found["nominal_pressure"], found["jrc_used"].item()
    place = {"rule": "Barton and Bandis", "block_length": 200.0}
    of_block, is_known = found["block_strength"].sel(place), reasons.sel(place) == ""
    assert is_known.any()
    expected = barton_strength(pressure, 30.0, *scaled_joint(jrc, 100.0, 200.0))
    np.testing.assert_allclose(of_block, expected.where(is_known))
    none = strength_of(twin, settings([0.2, 0.8]))
    assert none["block_strength"].size == 0


def within_largest_angle(end, strength):
    """An end of a peak strength, which no rule takes beyond the largest friction angle."""
    steepest = np.tan(np.radians(LARGEST_FRICTION_ANGLE)) * strength["nominal_pressure"]
    return np.where(end > steepest, np.maximum(steepest, strength["peak_strength"]), end)


def by_assumed_angle(value, strength, sign):
    """Change of a strength by an assumed phi_b that is off by 10 degrees, MPa."""
    pressure = strength["nominal_pressure"]
    angle = np.degrees(np.arctan(value / pressure))
    return shear_strength(pressure, angle + sign * 10)[0] - value


def test_the_peak_by_dilatancy_holds_other_windows_and_readings(twin):
    """Their curves rise by other angles; ends are those of the angle, truncated as it is."""
    chosen = settings([0.2, 0.8])
    dilatancy, joint = pressed(twin, chosen)
    alone = joint_strength(dilatancy, joint, twin, chosen).squeeze("contact_direction")
    assert np.isnan(alone["peak_angle_spread"])
    for end, sign in (("low", -1), ("high", 1)):
        value = alone["peak_strength"]
        off = np.hypot(alone["peak_strength_error"], by_assumed_angle(value, alone, sign))
        expected = within_largest_angle(np.maximum(value + sign * off, 0), alone)
        np.testing.assert_allclose(alone[f"peak_strength_{end}"], expected, rtol=1e-6)
    own = dilatancy["elastic_dilatancy"].isel(normal_force=1).values.ravel()
    slid = dilatancy["offset_on_grid"].values.ravel()
    curves = [own, own + 0.1 * slid, own - 0.05 * slid, own + 0.2 * slid]
    variants = {
        "variant_dilatancy": (("variant", "offset"), curves, {"direction": "W"}),
        "variant_kind": ("variant", [OWN, WINDOW, WINDOW, READ]),
        "windows_independent": 3.0,
    }
    found = joint_strength(dilatancy.assign(variants), joint, twin, chosen)
    found = found.squeeze("contact_direction")
    slopes = np.diff(np.c_[np.zeros(4), curves], axis=1) / np.diff(np.r_[0.0, slid])
    peaks = np.degrees(np.arctan(slopes)).max(axis=1)
    windows = t_quantile(2) * np.std(peaks[:3], ddof=1)
    half = np.hypot(windows, abs(peaks[3] - peaks[0]))
    assert found["peak_angle_spread"] == pytest.approx(half)
    value, low, high = (found[f"peak_strength{end}"] for end in ("", "_low", "_high"))
    np.testing.assert_array_equal(value, alone["peak_strength"])
    angles = found["peak_dilatancy_angle"]
    off = np.hypot(half, found["peak_dilatancy_angle_error"])
    for end, sign in ((low, -1), (high, 1)):
        by_angle, _ = shear_strength(found["nominal_pressure"], 30 + angles + sign * off)
        whole = np.hypot(by_angle - value, by_assumed_angle(value, found, sign))
        expected = within_largest_angle(np.maximum(value + sign * whole, 0), found)
        np.testing.assert_allclose(end, expected)


# Properties


def test_dilatancies_within_their_errors_give_strengths_within_theirs(twin):
    chosen = settings(OFFSETS)
    dilatancy, joint = pressed(twin, chosen)
    delta = dilatancy["elastic_dilatancy"]
    error = dilatancy["elastic_dilatancy_error"] = 0 * delta + 2e-4
    found = joint_strength(dilatancy, joint, twin, chosen)
    rng, reached = np.random.default_rng(1), {}
    for _ in range(20):
        signs = rng.choice([-1.0, 1.0], delta.shape)
        other = joint_strength(
            dilatancy.assign(elastic_dilatancy=delta + signs * error), joint, twin, chosen
        )
        for name in ("dilatancy_angle", "shear_strength", "peak_strength", "peak_dilatancy_angle"):
            off, bound = abs(other[name] - found[name]), found[f"{name}_error"]
            assert (off <= bound * (1 + 1e-9)).all(), name
            reached[name] = max(reached.get(name, 0.0), float((off / bound).max()))
    # The bound of a single interval is reached, that of a peak need not be.
    assert reached["dilatancy_angle"] > 0.99
    assert reached["shear_strength"] > 0.9
    assert (found["friction_angle_error"] == found["dilatancy_angle_error"]).all()


def test_west_on_the_mirrored_face_is_east(twin):
    heights = twin["lower"].values
    mirrored = make_specimen(scan(heights[:, ::-1]), window=3.2, reach=1.6, name="mirrored")
    west = strength_of(mirrored, settings([0.2, 0.8], ("W",)))
    east = strength_of(twin, settings([0.2, 0.8], ("E",)))
    for name in ("dilatancy_angle", "shear_strength", "z2", "jrc"):
        np.testing.assert_allclose(west[name], east[name], rtol=1e-5, atol=1e-5)


def test_load_takes_from_the_peak_angle(strength):
    peaks = strength["peak_dilatancy_angle"]
    rigid = strength["rigid_dilatancy_angle"].max("interval")
    assert (peaks.diff("normal_force") < 0).all()
    assert (peaks.isel(normal_force=0) < rigid).all()


def test_held_intervals_are_those_beyond_the_largest_angle(strength):
    above = (strength["friction_angle"] > LARGEST_FRICTION_ANGLE).sum("interval")
    np.testing.assert_array_equal(strength["truncated_high"], above)
    below = (strength["friction_angle"] < 0).sum("interval")
    np.testing.assert_array_equal(strength["truncated_low"], below)


def test_roughness_is_that_of_the_face_whatever_the_window_and_its_holes():
    heights = self_affine((96, 96), 0.3, 0.8, rms=0.5, seed=3)
    small, large = (
        profile_roughness(make_specimen(scan(heights, 0.3), window=w, name="face"), "E")
        for w in (6.0, 24.0)
    )
    for name, of in small.data_vars.items():
        np.testing.assert_array_equal(of, large[name], err_msg=name)
    levelled = without_mean_plane(heights)
    lag = 4  # 1.2 of 1.27 mm
    each = np.sqrt(np.mean((levelled[:, lag:] - levelled[:, :-lag]) ** 2, axis=1)) / (lag * 0.3)
    jrc = joint_roughness(each)
    half = t_quantile(jrc.size - 1) * jrc.std(ddof=1)
    whole = joint_roughness(np.sqrt(np.mean(each**2)))
    assert small["jrc_of_law"] == pytest.approx(whole)
    assert small["jrc_of_law_low"] == pytest.approx(whole - half)
    assert small["jrc_of_law_high"] == pytest.approx(whole + half)
    # A corner that was not measured takes its profiles away, and no more.
    heights[:30, :30] = np.nan
    holed = profile_roughness(make_specimen(scan(heights, 0.3), window=6.0, name="face"), "E")
    assert holed["jrc_of_law"] == pytest.approx(whole, abs=1.0)
    assert np.isfinite(holed["grasselli_roughness_low"])


def test_four_directions_stand_beside_those_that_slide(strength, twin):
    for direction in "ENWS":
        of_face = profile_roughness(twin, direction)
        rose = strength.sel(face_direction=direction)
        for end in ("", "_low", "_high"):
            np.testing.assert_array_equal(rose[f"face_jrc{end}"], of_face[f"jrc_of_law{end}"])
            np.testing.assert_array_equal(
                rose[f"face_grasselli{end}"], of_face[f"grasselli_roughness{end}"]
            )
    # A profile read backwards has the same slopes.
    for one, other in ("EW", "NS"):
        np.testing.assert_allclose(
            *(strength["face_jrc"].sel(face_direction=d) for d in (one, other))
        )


def test_roughness_used_stays_within_bartons_profiles(strength):
    steep = make_specimen(scan(saw(64, 5.0)), window=3.2, reach=0.7, name="steep")
    found = profile_roughness(steep, "E")
    assert found["jrc"].max() > JRC_RANGE[1]
    assert found["jrc_used"].item() in JRC_RANGE


def test_steps_are_whole_cells_whatever_the_spacing():
    heights = self_affine((48, 48), 3.0, 0.8, rms=3.0, seed=1)
    coarse = make_specimen(scan(heights, 3.0), window=72.0, reach=9.0, name="coarse")
    found = profile_roughness(coarse, "N")
    assert found["step"].values.tolist() == [3, 3, 3]
    # No fit was made for steps as long: there is no JRC, and none in a law.
    assert np.isfinite(found["z2"]).all()
    assert np.isnan(found["jrc"]).all()
    assert np.isnan(found["jrc_used"])
    fine = make_specimen(scan(heights / 30), window=2.4, reach=0.6, name="fine")
    found = profile_roughness(fine, "N")
    np.testing.assert_allclose(found["step"], [0.1, 0.5, 1.3])


@pytest.mark.parametrize(
    ("missing", "lost", "kept"),
    [
        (
            "basic_friction_angle",
            ("shear_strength", "truncated_high", "barton_strength"),
            "jrc_used",
        ),
        ("joint_wall_strength", ("barton_strength", "scaled_wall_strength"), "shear_strength"),
    ],
)
def test_what_the_study_does_not_state_is_missing_and_nothing_else(twin, missing, lost, kept):
    found = strength_of(twin, settings([0.2, 0.8], **{missing: np.nan}))
    for name in lost:
        assert np.isnan(found[name]).all()
    assert np.isfinite(found[kept]).all()
    assert np.isfinite(found["dilatancy_angle"]).all()


def test_two_faces_need_no_flush_start():
    lower = self_affine((64, 64), SPACING, 0.8, rms=0.1, seed=1, roll_off=2)
    upper = lower + 0.1 * self_affine((64, 64), SPACING, 0.8, rms=0.1, seed=2)
    pair = make_specimen(scan(lower), scan(upper), window=3.2, reach=1.6, name="pair")
    found = strength_of(pair, settings([0.0, 0.2, 0.8]))
    np.testing.assert_allclose(found["midpoint"], [[0.1, 0.5]])
    one = strength_of(pair, settings([0.2]))
    assert one.sizes["interval"] == 0
    assert np.isnan(one["peak_strength"]).all()
    assert np.isfinite(one["barton_strength"]).all()


def test_everything_says_what_it_is(strength):
    for name, variable in strength.data_vars.items():
        assert {"units", "long_name"} <= set(variable.attrs), name


def test_no_peak_of_a_joint_that_was_not_slid_was_held():
    none = np.full(2, np.nan)
    peaks = dict.fromkeys(("peak_offset", "peak_strength", "barton_strength"), none)
    values = {"midpoint": [], "friction_angle": np.empty((0, 2)), **peaks}
    judged = judged_strengths(values, np.zeros(2, bool))
    assert judged["peak_strength_valid"].all()
    assert judged["shear_strength_valid"].shape == (0, 2)


def test_a_peak_is_a_bound_only_where_its_own_angle_was_held():
    angle = np.array([[75.0, 75.0], [60.0, 60.0]])
    peaks = {"peak_offset": [1.0, 2.0], "peak_strength": [3.0, 2.0], "barton_strength": [2.0, 4.0]}
    values = {"midpoint": [1.0, 2.0], "friction_angle": angle, **peaks}
    judged = judged_strengths(values, np.zeros(2, bool))
    assert judged["peak_strength_valid"].tolist() == [False, True]
    assert judged["peak_strength_reason"].tolist() == [TRUNCATED, ""]
    assert judged["shear_strength_valid"].tolist() == [[False, False], [True, True]]
    assert judged["peak_over_barton"].tolist() == [1.5, 0.5]
    nearly_full = judged_strengths(values, np.array([False, True]))
    assert not nearly_full["peak_strength_valid"].any()
    assert nearly_full["peak_strength_reason"].tolist() == [TRUNCATED, HALF_TOUCHES]


def test_no_strength_by_dilatancy_where_half_of_the_window_touches():
    """The faces close as they slide there: its peak would fall as the pressure rises."""
    lower = self_affine((64, 64), SPACING, 0.8, rms=0.1, seed=3)
    specimen = make_specimen(scan(lower), window=3.2, reach=1.6, name="one")
    found = strength_of(specimen, settings([0.2, 0.4, 0.8], hardness=40.0))
    np.testing.assert_allclose(found["nominal_pressure"], [0.5, 5, 25])
    assert (found["peak_strength_reason"] == HALF_TOUCHES).values.tolist() == [[False, False, True]]
    assert not found["shear_strength_valid"].isel(normal_force=2).any()
