"""Sub-windows of a joint, and how its mechanics goes with size."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from ensembles import ensemble
from places import SCANS
from stated import read_faces
from symmetries import LENGTH, STRESS, differences, grown, with_axes_exchanged

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.fitting import fit_line
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.core.settings import Friction, Material, Solver, StrengthSettings
from fractalcontact.core.window import window_sides
from fractalcontact.joint.barton import scaled_joint
from fractalcontact.laws.closure import closure_curves
from fractalcontact.laws.strength import joint_strength
from fractalcontact.roughness.estimators.roughness_length import roughness_length_curves
from fractalcontact.size_effect.division import MIN_CELLS, PARTS, split, spread_windows
from fractalcontact.size_effect.laws import size_laws
from fractalcontact.size_effect.local_roughness import local_roughness
from fractalcontact.size_effect.strength_laws import OFFSET_FRACTIONS
from fractalcontact.size_effect.window_means import power_through
from fractalcontact.size_effect.windows import window_states
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.states import SOLVER_ERROR, combine
from fractalcontact.states.sweep import contact_states
from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SOLVER, EXACT = (Solver(rtol, "love", None) for rtol in (1e-6, 1e-9))
DIMENSION = Estimate(2.2, 2.15, 2.25)
ROCK = Friction(basic_friction_angle=30.0, joint_wall_strength=100.0)


def scan(heights, spacing=(0.1, 0.1)):
    coordinates = [s * (np.arange(n) + 0.5) for n, s in zip(heights.shape, spacing, strict=True)]
    attrs = {"spacing_y": spacing[0], "spacing_x": spacing[1], "source": "made", "sha256": "0" * 64}
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


def settings(loads=("2 MPa", "20 MPa"), opposite="match"):
    study = {
        "materials": {},
        "defaults": {
            "material": {"modulus": "20 GPa", "poisson": 0.2},
            "opposite": opposite,
            "loads": list(loads),
            "dilatancy_loads": list(loads),
            "resolutions": [1],
        },
    }
    return resolve_settings(study, "made", {}, "made")


def states_of(specimen, direction, cells, chosen, parts=PARTS, *, solver=SOLVER, **options):
    return window_states(JointLoading(specimen, direction, cells, chosen, solver), parts, **options)


@pytest.fixture(scope="module")
def rock():
    """Self-affine without a roll-off."""
    heights = self_affine((192, 192), 0.1, 0.8, rms=0.3, seed=11)
    return make_specimen(scan(heights), window=12.8, reach=3.2, name="rock")


@pytest.fixture(scope="module")
def states(rock):
    return states_of(rock, "W", [1, 2, 4, 8, 16, 32], settings(), (1, 2, 4, 8))


@pytest.fixture(scope="module")
def laws(states):
    return size_laws(states, ROCK, 12.0, DIMENSION)


# In other units, and with x for y


@pytest.fixture(scope="module")
def oblong():
    """States of sub-windows on oblong cells: first, in other units, with x and y exchanged."""
    heights = self_affine((96, 96), 0.1, 0.8, rms=0.05, seed=4)[:56]
    found = []
    for z, length, stress, way in (
        (heights, 1.0, 1.0, "E"),
        (heights, LENGTH, STRESS, "E"),
        (heights.T, 1.0, 1.0, "N"),
    ):
        spacing = (0.15 * length, 0.1 * length)[:: -1 if way == "N" else 1]
        window = (4.8 * length, 6.4 * length)[:: -1 if way == "N" else 1]
        loads = [f"{2 * stress} MPa", f"{20 * stress} MPa"]
        chosen = settings(loads)
        stiffer = replace(chosen.material, e_star=stress * chosen.material.e_star)
        chosen = replace(chosen, material=stiffer)
        specimen = make_specimen(scan(length * z, spacing), window=window, name="oblong")
        found.append(states_of(specimen, way, [3, 6], chosen, (1, 2), solver=EXACT))
    return found


def test_states_of_sub_windows_are_in_the_units_that_they_state(oblong):
    first, other, _ = oblong
    found = differences(other, grown(first), rtol=1e-4)
    assert not [name for name in found if SOLVER_ERROR not in first[name].attrs["long_name"]]


def test_states_of_sub_windows_do_not_depend_on_which_axis_is_called_x(oblong):
    first, _, turned = oblong
    found = differences(
        with_axes_exchanged(turned), first, rtol=1e-5, atol=1e-5, unordered=("window",)
    )
    assert not [name for name in found if SOLVER_ERROR not in first[name].attrs["long_name"]]


# Exact


def test_split_cuts_every_cell_once():
    heights = np.arange(48.0).reshape(6, 8)
    windows = split(heights, 2)
    assert windows.shape == (4, 3, 4)
    assert np.array_equal(windows[1], heights[:3, 4:])
    assert sorted(windows.ravel()) == sorted(heights.ravel())
    assert np.array_equal(split(heights, 1)[0], heights)


def test_cells_that_do_not_divide_stay_at_the_edges():
    windows = split(np.arange(121.0).reshape(11, 11), 3)
    assert windows.shape == (9, 3, 3)
    assert windows[0, 0, 0] == 11 + 1
    assert windows[-1, -1, -1] == 9 * 11 + 9


@pytest.mark.parametrize(("parts", "most"), [(1, 16), (4, 16), (6, 16), (8, 16), (8, 5), (3, 1)])
def test_windows_are_spread_evenly_and_never_more_than_asked(parts, most):
    chosen = spread_windows(parts, most)
    assert len(chosen) == len(set(chosen)) <= most
    assert set(chosen) <= set(range(parts**2))
    rows, columns = np.divmod(chosen, parts)
    assert set(rows) == set(columns)
    # As far from one edge as from the other, within a sub-window.
    assert abs((rows.min() + rows.max()) - (parts - 1)) <= 1


def test_a_plane_is_not_rough():
    y, x = np.mgrid[:20, :24] * 0.1
    plane = (3 + 2 * x - y)[np.newaxis]
    assert local_roughness(plane) == pytest.approx(0, abs=1e-12)


def test_a_joint_of_equal_tiles_has_no_size():
    tile = self_affine((24, 24), 0.1, 0.8, rms=0.05, seed=3)
    tiled = make_specimen(scan(np.tile(tile, (2, 2))), opposite="flat", window=4.8, name="tiles")
    states = states_of(tiled, "none", [0], settings(opposite="flat"), (2,))
    for name in ("interface_closure", "sigma_z", "area_share"):
        values = states[name].values
        np.testing.assert_allclose(values, values[:, :1].repeat(4, axis=1), rtol=1e-5)


def test_flush_faces_have_nothing_to_close(rock):
    states = states_of(rock, "W", [0], settings(), (1, 2))
    for name in ("interface_closure", "sigma_z", "rigid_opening"):
        assert (states[name].isel(part=0, window=0) == 0).all()
    np.testing.assert_allclose(states["area_share"].isel(part=0, window=0), 1)
    assert np.isnan(states["interface_compliance"]).all()


def test_similarity_holds_for_a_joint_enlarged_in_all_its_lengths():
    # Sect. 3: b -> 2b with sigma_z -> 2 sigma_z gives 2 w_int at one nominal pressure.
    heights = self_affine((96, 96), 0.1, 0.8, rms=0.1, seed=7)
    rocks = (
        make_specimen(
            scan(k * heights, (k * 0.1, k * 0.1)), window=k * 4.8, reach=k * 1.6, name="rock"
        )
        for k in (1, 2)
    )
    small, large = (states_of(rock, "E", [2, 8], settings(), (1, 2)) for rock in rocks)
    np.testing.assert_allclose(large["side"], 2 * small["side"])
    np.testing.assert_allclose(large["nominal_pressure"], small["nominal_pressure"])
    for name, power in (
        ("interface_closure", 1),
        ("interface_compliance", 1),
        ("sigma_z", 1),
        ("rigid_opening", 1),
        ("area_share", 0),
        ("stiffness", 1),
    ):
        np.testing.assert_allclose(large[name], 2**power * small[name], rtol=1e-4)


def powers_of_side(states, exponent):
    """The states with w_int and sigma_z that are exact powers of the side."""
    made = states.copy(deep=True)
    side = made["side"]
    made["interface_closure"] = 1e-3 * side**exponent + 0 * made["interface_closure"]
    made["interface_closure"].attrs = states["interface_closure"].attrs
    made["nodes"] = 100 + 0 * made["nodes"]
    made["face_sigma_z"] = (0.01 * made["scale_side"] ** exponent).assign_attrs(units="mm")
    return made


def test_exact_powers_are_found_again(states):
    found = size_laws(powers_of_side(states, 0.6), ROCK, 12.0, DIMENSION)
    for end in ("", "_low", "_high"):
        np.testing.assert_allclose(found[f"closure_exponent{end}"], 0.6, atol=1e-9)
        np.testing.assert_allclose(found[f"face_hurst{end}"], 0.6, atol=1e-9)
    np.testing.assert_allclose(found["closure_exponent_b_min"], states["side"].min())
    np.testing.assert_allclose(found["closure_exponent_b_max"], 12.8)


@pytest.mark.parametrize("exponent", [-0.4, 0.3])
def test_lines_of_laws_lie_on_exact_powers_and_end_where_these_are_fitted(states, exponent):
    found = size_laws(powers_of_side(states, exponent), ROCK, 12.0, DIMENSION)
    fitted, line = found["interface_closure_fitted"], found["interface_closure_law"]
    assert fitted.any()
    np.testing.assert_array_equal(line.notnull(), fitted)
    np.testing.assert_allclose(line, found["interface_closure"].where(fitted), rtol=1e-9)
    np.testing.assert_array_equal(
        found["face_sigma_z_expected"].notnull(), found["face_sigma_z_fitted"]
    )


@pytest.mark.parametrize("exponent", [-0.8, 0.5])
def test_a_power_through_scattered_values_leaves_their_mean_logarithm(exponent):
    side = xr.DataArray([1.0, 2.0, 4.0, 8.0], dims="part")
    values = xr.DataArray([1.0, 3.0, -1.0, 5.0], dims="part", attrs={"units": "mm"})
    line = power_through(values, side, xr.DataArray(exponent), "a line")
    assert np.isnan(line[2])
    left = np.log(values.where(values > 0) / line)
    assert abs(float(left.mean())) < 1e-12
    slopes = np.diff(np.log(line.values[:2])) / np.diff(np.log(side.values[:2]))
    np.testing.assert_allclose(slopes, exponent)
    assert line.attrs == {"units": "mm", "long_name": "a line"}


def test_slopes_of_a_self_affine_face_lie_about_those_that_are_positive(laws):
    slope, line = laws["slope_at_equal_v_over_b"], laws["slope_at_equal_v_over_b_expected"]
    everywhere = (slope > 0).all("normal_force")
    enough = everywhere.sum("part") >= 3
    assert enough.any()
    np.testing.assert_array_equal(line.notnull(), (everywhere & enough).transpose(*line.dims))
    logs = np.log(slope.where(everywhere)).mean("normal_force") - np.log(line)
    np.testing.assert_allclose(logs.mean("part").values[enough.values], 0, atol=1e-12)
    exponents = np.log(line / laws["side"] ** (laws["expected_hurst"] - 1))
    np.testing.assert_allclose(exponents.std("part").values[enough.values], 0, atol=1e-12)


def test_a_trend_is_one_only_where_the_interval_of_its_exponent_says_so(laws):
    low, high = (laws[f"slope_at_equal_v_over_b_exponent_{end}"] for end in ("low", "high"))
    trend = laws["slope_at_equal_v_over_b_trend"]
    np.testing.assert_array_equal(trend == "falling", high < 0)
    np.testing.assert_array_equal(trend == "rising", low > 0)


def slid_by(states, opening):
    """States without closure whose rigid opening is a function of v and b, mm."""
    made = climbing(states, [1.0] * 4)
    openings = opening(made["offset"], made["side"]).broadcast_like(made["rigid_opening"])
    made["rigid_opening"] = openings.transpose("part", "window", "offset").where(
        states["rigid_opening"].notnull()
    )
    return size_laws(made, ROCK, 12.0, DIMENSION)


def test_a_slope_that_falls_with_v_alone_falls_with_b_at_one_v_over_b_and_not_at_one_v(states):
    found = slid_by(states, lambda v, b: 0.3 * v**0.6 + 0 * b)
    known = found["slope_at_equal_v_over_b_exponent"].notnull()
    assert known.any()
    assert (found["slope_at_equal_v_over_b_exponent_high"].where(known, -1) < 0).all()
    for name in ("slope", "strength"):
        whole, parts = found[f"{name}_of_whole_at_equal_v"], found[f"{name}_at_equal_v_over_b"]
        np.testing.assert_allclose(parts.where(whole.notnull()), whole.transpose(*parts.dims))
    at_one_v = found["slope_at_equal_v_exponent"]
    np.testing.assert_allclose(at_one_v.where(at_one_v.notnull(), 0), 0, atol=1e-9)


def test_a_slope_that_falls_with_b_falls_at_one_v_too(states):
    found = slid_by(states, lambda v, b: 0.3 * v * b**-0.4)
    at_one_v = found["slope_at_equal_v_exponent"]
    known = at_one_v.notnull().values
    assert known.any()
    np.testing.assert_allclose(at_one_v.values[known], -0.4)


def test_sizes_in_fewer_than_three_steps_of_sliding_have_no_law_at_one_v_over_b(states):
    found = size_laws(states.isel(offset=[0, 5]), ROCK, 12.0, DIMENSION)
    assert np.isfinite(found["slope_at_equal_v_over_b"]).any()
    for name in ("slope_at_equal_v_over_b_exponent", "strength_at_equal_v_over_b_exponent"):
        assert np.isnan(found[name]).all(), name


def test_a_self_similar_climb_has_one_strength_at_one_share_of_the_side(states):
    # delta = b f(v/b): larger in all its lengths, so that sizes differ at one v but not at one v/b.
    made = states.copy(deep=True)
    v, b = made["offset"], made["side"]
    made["interface_closure"] = 0 * made["interface_closure"]
    made["rigid_opening"] = (0.5 * v + 0 * b).transpose("part", "offset").expand_dims(
        window=made.sizes["window"]
    ).transpose("part", "window", "offset") + 0 * states["rigid_opening"]
    found = size_laws(made, ROCK, 12.0, DIMENSION)
    angle = 30 + np.degrees(np.arctan(0.5))
    expected = made["nominal_pressure"].values * np.tan(np.radians(angle))
    np.testing.assert_allclose(found["peak_strength"], np.tile(expected, (4, 1)))
    similar = found["strength_at_equal_v_over_b"].values
    known = np.isfinite(similar)
    np.testing.assert_allclose(similar[known], np.broadcast_to(expected, similar.shape)[known])
    # v = share b lies between the first step of 0.1 mm and the last of 3.2 mm.
    reached = np.outer(OFFSET_FRACTIONS, b) >= 0.1 - 1e-9
    np.testing.assert_array_equal(known.all(axis=2), reached)
    np.testing.assert_allclose(found["slope_at_equal_v_over_b_exponent"][-1], 0, atol=1e-9)


def climbing(states, slopes):
    """States whose joints climb by given slopes, one a size, without closure."""
    made = states.copy(deep=True)
    made["interface_closure"] = 0 * made["interface_closure"]
    made["interface_closure_error"] = 0 * made["interface_closure_error"]
    slope = xr.DataArray(slopes, dims="part", coords={"part": made["part"]})
    opening = (slope * made["offset"]).broadcast_like(made["rigid_opening"])
    made["rigid_opening"] = opening.transpose("part", "window", "offset").where(
        states["rigid_opening"].notnull()
    )
    return made


def test_a_size_whose_sub_windows_are_held_at_their_bound_says_so_at_the_peak(states):
    # 30 + 45 degrees are held at 70.
    found = size_laws(climbing(states, [0.5, 0.5, 0.5, 1.0]), ROCK, 12.0, DIMENSION)
    truncated = found["truncated_fraction_at_peak"]
    np.testing.assert_array_equal(truncated.sel(part=8), 1)
    np.testing.assert_array_equal(truncated.sel(part=[1, 2, 4]), 0)


def test_bounds_at_small_sizes_bound_the_exponent_at_one_v_over_b_from_above(states):
    # The strengths of the two small sizes are bounds, whatever lies beyond.
    slopes = [0.2, 0.5, 1.0, 1.0]
    found = size_laws(climbing(states, slopes), ROCK, 12.0, DIMENSION).isel(share=-1)
    name = "strength_at_equal_v_over_b_exponent"
    assert np.isneginf(found[f"{name}_low"]).all()
    strength = [np.tan(np.radians(min(30 + np.degrees(np.arctan(s)), 70))) for s in slopes]
    most = fit_line(np.log(found["side"].values), np.log(strength)).slope
    np.testing.assert_allclose(found[name], most.value)
    np.testing.assert_allclose(found[f"{name}_high"], most.high)
    steeper = np.polyfit(np.log(found["side"].values), np.log(strength * np.array([1, 1, 1, 9])), 1)
    assert steeper[0] < most.value
    # A bound at a size beyond the middle bounds nothing from above, and is left out.
    found = size_laws(climbing(states, [0.5, 1.0, 0.5, 0.5]), ROCK, 12.0, DIMENSION)
    np.testing.assert_array_equal(found[f"{name}_n"].isel(share=-1), 3)
    np.testing.assert_allclose(found[name].isel(share=-1), 0, atol=1e-9)


def test_a_strength_raised_to_0_is_no_lower_bound_and_takes_its_size_out_of_the_fit(states):
    made = climbing(states, [0.5] * 4)
    falling = made["rigid_opening"].copy()
    falling.loc[{"part": 8, "window": 3}] = -made["offset"]
    made["rigid_opening"] = falling
    found = size_laws(made, ROCK, 12.0, DIMENSION).isel(share=-1)
    name = "strength_at_equal_v_over_b_exponent"
    np.testing.assert_array_equal(found[f"{name}_n"], 3)
    np.testing.assert_allclose([found[name], found[f"{name}_low"]], 0, atol=1e-9)


def test_bartons_law_ends_with_his_scale_of_roughness(states):
    found = size_laws(states, ROCK, 12.0, DIMENSION)
    scaled = scaled_joint(12.0, 100.0, states["side_along"].values)[0]
    on_scale = scaled <= 20
    assert on_scale.any()
    assert not on_scale.all()
    np.testing.assert_array_equal(np.isfinite(found["barton_roughness"]), on_scale)
    np.testing.assert_array_equal(
        np.isfinite(found["barton_scaled_strength"]).all("normal_force"), on_scale
    )


# Against another way


def test_local_roughness_is_that_of_the_plane_by_least_squares():
    windows = split(self_affine((60, 48), 0.1, 0.7, rms=1, seed=4), 3)
    residual = np.array([without_mean_plane(w) for w in windows])
    expected = np.sqrt((residual**2).sum(axis=(1, 2)) / (residual[0].size - 3))
    np.testing.assert_allclose(local_roughness(windows), expected, rtol=1e-10)


def test_local_roughness_is_that_of_the_roughness_length_estimator():
    heights = self_affine((128, 128), 0.1, 0.8, rms=1, seed=4)
    curve = roughness_length_curves(heights, 0.1)["both"]
    sides, rms = curve.length, np.sqrt(curve.measure())
    for side in (8, 16, 32):
        own = local_roughness(split(heights, 128 // side))
        at = np.flatnonzero(np.isclose(sides, side * 0.1)).item()
        assert np.sqrt(np.mean(own**2)) == pytest.approx(rms[at], rel=1e-10)


def test_the_whole_window_is_the_specimen_itself(rock, states):
    whole = combine([contact_states(JointLoading(rock, "W", [1, 8, 32], settings(), SOLVER), [1])])
    curves = closure_curves(whole, window_sides(rock), settings().material.e_star)
    curves = curves.sel(direction="W", resolution=1)
    one = states.sel(part=1, offset=curves["offset"], method="nearest").isel(window=0)
    for name in ("closure", "interface_closure", "area", "stiffness"):
        np.testing.assert_allclose(one[name], curves[name], rtol=1e-5)
    np.testing.assert_allclose(one["rigid_opening"], curves["rigid_opening"])
    np.testing.assert_allclose(
        one["interface_compliance"], 1 / curves["interface_stiffness"], rtol=1e-4
    )


def test_strength_of_the_whole_window_is_that_of_the_joint(rock, states, laws):
    delta = (states["rigid_opening"] - states["interface_closure"]).sel(part=1).isel(window=0)
    dilatancy = xr.Dataset(
        {
            "elastic_dilatancy": delta.expand_dims(contact_direction=["W"]),
            "elastic_dilatancy_error": 0 * delta.expand_dims(contact_direction=["W"]),
            "offset_on_grid": (("contact_direction", "offset"), [states["offset"].values]),
        }
    )
    cells = (("contact_direction", "offset"), [[1, 2, 4, 8, 16, 32]])
    joint = xr.Dataset({"offset_cells": cells}, {"contact_direction": ["W"]})
    elastic = {"name": "rock", "modulus": 9600.0, "poisson": 0.2, "e_star": 1e4, "hardness": np.inf}
    material = Material(**vars(ROCK), **elastic)
    strength = joint_strength(dilatancy, joint, rock, StrengthSettings(material, None, ()))
    strength = strength.sel(contact_direction="W")
    one = laws.sel(part=1)
    np.testing.assert_allclose(one["peak_strength"], strength["peak_strength"])
    assert strength["step"].sel(sampling="1.27 mm") == pytest.approx(1.3)


def test_loose_states_are_off_by_no_more_than_they_say(rock, laws):
    chosen = [1, 2, 4, 8, 16, 32]
    loose = Solver(1e-2, "love", None)
    states = states_of(rock, "W", chosen, settings(), (1, 2, 4, 8), solver=loose)
    found = size_laws(states, ROCK, 12.0, DIMENSION)
    differ = 0
    for name in (
        *("interface_closure", "interface_compliance", "area_share"),
        *("peak_strength", "strength_at_equal_v_over_b", "slope_at_equal_v_over_b"),
    ):
        off, bound = abs(found[name] - laws[name]), found[f"{name}_error"] + laws[f"{name}_error"]
        assert bound.dims == off.dims, name
        np.testing.assert_array_equal(np.isfinite(bound), np.isfinite(off), err_msg=name)
        inside = off <= bound + 1e-12 * abs(laws[name])
        assert inside.where(np.isfinite(off), True).all(), name
        differ += int((off > 1e-9 * abs(laws[name])).sum())
    assert differ > 100


# Properties


def test_eq_2_finds_the_exponent_the_faces_were_made_with():
    found = []
    for seed in range(ensemble("faces of one exponent")):
        face = make_specimen(
            scan(self_affine((192, 192), 0.1, 0.8, rms=0.3, seed=seed)), window=12.8, reach=3.2
        )
        states = states_of(face, "W", [32], settings(["5 MPa"]), (8,), most=1)
        laws = size_laws(states, ROCK, 12.0, DIMENSION)
        found.append([laws["face_hurst"].item(), laws["hurst"].item()])
    # One surface of this size scatters by 0.04-0.05.
    np.testing.assert_allclose(np.mean(found, axis=0), 0.8, atol=0.04)


def test_eq_2_expects_three_less_the_dimension(laws):
    assert laws["expected_hurst"].item() == pytest.approx(0.8)
    assert (laws["expected_hurst_low"], laws["expected_hurst_high"]) == pytest.approx((0.75, 0.85))


def test_the_composite_follows_eq_2_only_where_it_slid_as_far_as_its_windows_are_wide(laws):
    # Slid by one cell it is much the same everywhere: hardly any growth with b.
    assert laws["hurst"][0] < 0.35
    assert laws["hurst"][-1] > 2 * laws["hurst"][0]
    assert laws["hurst"][-1] > laws["hurst"][2] > laws["hurst"][0]


def test_larger_windows_close_more(laws):
    closure = laws["interface_closure"].isel(offset=[3, 4, 5])
    assert (closure.diff("part") < 0).all()  # parts ascending: sizes descending
    # Under the lighter load hardly two sizes hold ten nodes in every window.
    resolved = laws.isel(normal_force=1)
    assert (resolved["closure_exponent"] > 0).all()
    assert (resolved["closure_exponent_low"].isel(offset=[2, 3]) > 0).all()


def test_windows_too_small_are_left_out(rock):
    states = states_of(rock, "W", [4], settings(["5 MPa"]), (1, 8, 9), most=1)
    assert states["part"].values.tolist() == [1, 8]  # 128 / 8 = 16 cells, 128 / 9 = 14
    assert MIN_CELLS == 16


@pytest.mark.parametrize("cells", [[2, 4], [2]])
def test_a_window_of_few_cells_has_one_size_and_no_law(cells):
    heights = self_affine((24, 24), 0.1, 0.8, rms=0.1, seed=2)
    tiny = make_specimen(scan(heights), window=1.2, reach=0.4, name="tiny")
    found = size_laws(states_of(tiny, "E", cells, settings()), ROCK, 12.0, DIMENSION)
    assert found["part"].values.tolist() == [1]
    assert np.isfinite(found["interface_closure"]).all()
    for name in (
        "closure_exponent",
        "face_hurst",
        "slope_at_equal_v_over_b_exponent",
    ):
        assert np.isnan(found[name]).all()


def test_windows_that_are_not_there_are_missing(states):
    assert states["sigma_z"].notnull().sum("window").isel(offset=0).values.tolist() == [
        1,
        4,
        16,
        16,
    ]
    assert states["interface_closure"].sel(part=2)[4:].isnull().all()


def test_forces_are_those_of_the_whole_window_at_one_pressure_for_all(rock):
    in_newton = settings(["1638.4 N"])  # 10 MPa on 12.8 x 12.8 mm
    states = states_of(rock, "W", [4], in_newton, (2,), most=1)
    np.testing.assert_allclose(states["nominal_pressure"], 10)
    np.testing.assert_allclose(
        states["bulk_settlement"], 0.946402 * 10 * 6.4 / 10416.667, rtol=1e-5
    )


def test_a_surface_against_a_plane_has_no_strength():
    face = make_specimen(
        scan(self_affine((64, 64), 0.1, 0.8, rms=0.1, seed=2)), opposite="flat", name="flat"
    )
    states = states_of(face, "none", [0], settings(opposite="flat"))
    found = size_laws(states, ROCK, np.nan, DIMENSION)
    assert "peak_strength" not in found
    assert (found["interface_closure"] > 0).all()
    np.testing.assert_allclose(found["sigma_z_all"][0], found["face_sigma_z"])


def test_what_the_study_does_not_state_is_missing(states):
    unstated = Friction(basic_friction_angle=np.nan, joint_wall_strength=np.nan)
    found = size_laws(states, unstated, 12.0, DIMENSION)
    for name in (
        "peak_strength",
        "strength_at_equal_v_over_b",
        "truncated_fraction_at_peak",
        "barton_scaled_strength",
    ):
        assert np.isnan(found[name]).all()
    assert np.isfinite(found["slope_at_equal_v_over_b"][-1]).all()


def test_two_faces_and_an_oblong_window():
    lower = self_affine((96, 96), 0.1, 0.8, rms=0.1, seed=1, roll_off=2)
    upper = lower + 0.1 * self_affine((96, 96), 0.1, 0.8, rms=0.1, seed=2)
    pair = make_specimen(scan(lower), scan(upper), window=(3.2, 6.4), reach=1, name="pair")
    states = states_of(pair, "E", [0, 2, 8], settings())
    assert states["side"][0] == pytest.approx(np.sqrt(3.2 * 6.4))
    assert states["side_along"][0] == pytest.approx(6.4)
    found = size_laws(states, ROCK, 12.0, DIMENSION)
    assert np.isfinite(found["peak_strength"]).all()
    assert (states["interface_closure"].isel(offset=0, window=0) > 0).all()


def test_everything_says_what_it_is(states, laws):
    for dataset in (states, laws):
        for name, variable in dataset.data_vars.items():
            assert {"units", "long_name"} <= set(variable.attrs), name


# Real scans


@pytest.mark.full
@pytest.mark.scans
def test_larger_windows_of_real_granite_close_more():
    folder = SCANS / "cnl_granite_pair"
    if not folder.exists():
        pytest.skip("the real scans are not beside the project")
    files = ("Extracted_M_CNL_SideA_bottom.txt", "Extracted_M_CNL_SideB_top.txt")
    pair = read_faces(*(folder / name for name in files), {"unit": "mm"})
    granite = make_specimen(*pair, window=38.4, reach=3.0, name="granite")
    states = states_of(granite, "E", [0, 10], settings(), (1, 2, 4))
    found = size_laws(states, ROCK, 12.0, DIMENSION)
    assert found["part"].values.tolist() == [1, 2, 4]
    assert (found["interface_closure"].diff("part") < 0).all()
    assert 0.6 < found["face_hurst"] < 0.85
