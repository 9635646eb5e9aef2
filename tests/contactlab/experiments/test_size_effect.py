"""The experiment on the size effect: surfaces, jobs, and what is concluded from made states."""

import numpy as np
import pytest
import xarray as xr

from contactlab.experiments.size_decision import paired_exponent
from contactlab.experiments.size_effect_verdict import size_effect_verdict
from contactlab.experiments.size_states import seed_of, solve_task
from contactlab.experiments.size_tasks import size_jobs, size_tasks
from fractalcontact.core.errors import InputError
from fractalcontact.laws.theory import (
    FUDGE,
    PERIODIC_AREAS,
    PERIODIC_SLOPE,
    fudged_persson_area,
    linear_area,
    persson_area,
)
from fractalcontact.surface.synthesis import band_limited, band_slope

RECIPE = {
    "hurst": [0.5, 0.8],
    "loads": [0.01, 0.05, 0.1],
    "cut_off": 8,
    "roll_off": 16,
    "roll_off_fraction": 0.25,
    "arms": {
        "R": {"sizes": [64], "surfaces": [3], "cut_offs": [4, 8, 16]},
        "S1": {"sizes": [64, 96], "surfaces": [3, 2]},
        "S3": {"sizes": [64], "surfaces": [2]},
        "W": {"sizes": [32, 64], "surfaces": [2, 2]},
        "G": {
            "sizes": [96],
            "surfaces": [2],
            "constructions": ["weierstrass-mandelbrot", "random-midpoint", "cantor-punch"],
        },
    },
}


@pytest.fixture(scope="module")
def parts():
    return [solve_task(task, RECIPE["loads"], 1e-5) for task in size_tasks(RECIPE)]


@pytest.fixture(scope="module")
def found(parts):
    return size_effect_verdict(parts, RECIPE)


def test_every_surface_has_a_job_of_its_own_or_shares_one():
    recipe = RECIPE | {
        "arms": {
            "R": {"sizes": [64], "surfaces": [3], "cut_offs": [4, 8]},
            "S1": {"sizes": [4096, 128], "surfaces": [3, 40]},
        }
    }
    tasks = size_tasks(recipe)
    assert len({task.name for task in tasks}) == len(tasks)
    counted = {}
    for task in tasks:
        key = task.arm, task.hurst, task.size, task.cut_off
        counted.setdefault(key, []).extend(range(task.first, task.first + task.surfaces))
    assert counted["S1", 0.5, 4096, 8] == [0, 1, 2]
    assert counted["S1", 0.8, 128, 8] == list(range(40))
    assert len(counted) == 2 * (2 + 2)
    assert max(task.surfaces for task in tasks if task.size == 4096) == 1


def test_small_classes_share_a_job_and_large_ones_do_not():
    jobs = size_jobs(RECIPE)
    assert sorted(task for tasks in jobs.values() for task in tasks) == sorted(size_tasks(RECIPE))
    assert {name: name == tasks[0].name for name, tasks in jobs.items()} == dict.fromkeys(
        jobs, True
    )
    assert len(jobs) == 2 * len(RECIPE["arms"])
    large = RECIPE | {"arms": {"S1": {"sizes": [64, 128, 1024], "surfaces": [4, 4, 40]}}}
    sizes = sorted([task.size for task in tasks] for tasks in size_jobs(large).values())
    assert sizes == 2 * [[128, 64]] + 6 * [[1024]]


def test_windows_are_parts_of_the_surfaces_without_a_roll_off():
    whole = next(t for t in size_tasks(RECIPE) if t.arm == "S3" and t.hurst == 0.5)
    part = next(t for t in size_tasks(RECIPE) if t.arm == "W" and t.size == 32 and t.hurst == 0.5)
    same = next(t for t in size_tasks(RECIPE) if t.arm == "W" and t.size == 64 and t.hurst == 0.5)
    assert seed_of(whole, 1) == seed_of(part, 1) == seed_of(same, 1)
    loads = RECIPE["loads"]
    states = solve_task(same, loads, 1e-5)
    # One window is the surface itself.
    np.testing.assert_allclose(
        states["corrected_share"], solve_task(whole, loads, 1e-5)["corrected_share"], rtol=1e-3
    )
    assert solve_task(part, loads, 1e-5)["nodes"].max() < states["nodes"].max()


def test_windows_of_one_surface_have_its_exponent():
    sides, surfaces = np.tile([1.0, 2.0, 4.0], 5), np.repeat(np.arange(5), 3)
    # Surfaces that differ by a factor differ in no exponent.
    exact = paired_exponent(sides, (1 + surfaces) * sides**-0.3, surfaces)
    assert exact.value == pytest.approx(-0.3)
    assert exact.error == pytest.approx(0, abs=1e-12)
    noise = np.exp(np.random.default_rng(1).normal(0, 0.1, 15))
    rough = paired_exponent(sides, sides**-0.3 * noise, surfaces)
    assert rough.low < -0.3 < rough.high
    assert np.isnan(paired_exponent(sides[:3], sides[:3], surfaces[:3]).error)


def test_other_constructions_stand_beside_their_cuts(found):
    assert list(found["construction"]) == [
        "cantor-punch",
        "random-midpoint",
        "weierstrass-mandelbrot",
    ]
    delta = found["geometry_delta"].isel(reduced_pressure=-1)
    assert ((delta > 0) & (delta < 2.1)).all()


@pytest.mark.parametrize(
    ("arm", "stated", "words"),
    [
        ("S1", {"sizes": [64, 128], "surfaces": [3]}, "2 sizes and 1 numbers of surfaces"),
        ("R", {"sizes": [64], "surfaces": [3], "cut_offs": [4, 32]}, "shorter than the cut-off"),
    ],
)
def test_what_cannot_be_made_is_refused(arm, stated, words):
    with pytest.raises(InputError, match=words):
        size_tasks(RECIPE | {"arms": {arm: stated}})


def test_a_cut_off_filters_the_same_surface():
    fine, coarse = (task for task in size_tasks(RECIPE) if task.name in _named("R", 4, 8))
    assert seed_of(fine, 1) == seed_of(coarse, 1) != seed_of(fine, 2)
    heights = {}
    for cut_off in (4.0, 8.0):
        kwargs = {"prefactor": 1.0, "cut_off": cut_off, "roll_off": 16.0, "seed": 3}
        heights[cut_off] = band_limited((64, 64), 1.0, 0.8, **kwargs)
    rest = heights[4.0] - heights[8.0]
    # What the finer one has more is shorter than 8 nodes: over 16 nodes it averages out.
    means = rest.reshape(4, 16, 4, 16).mean(axis=(1, 3))
    assert abs(means).max() < 0.2 * rest.std()


def _named(arm, *cut_offs):
    return {f"{arm}_0.5_64_{cut_off}_0" for cut_off in cut_offs}


@pytest.mark.parametrize("size", [64, 128, 256])
def test_slopes_do_not_depend_on_the_size(size):
    kwargs = {"prefactor": 1e-3, "cut_off": 8.0, "roll_off": 16.0}
    slope = band_slope((size, size), 1.0, 0.8, **kwargs)
    assert slope == pytest.approx(band_slope((256, 256), 1.0, 0.8, **kwargs), rel=1e-2)
    surfaces = [band_limited((size, size), 1.0, 0.8, seed=seed, **kwargs) for seed in range(8)]
    # Differences over two nodes of waves of 8 and more are less than their slope by up to a tenth.
    squares = [np.mean(np.gradient(h, axis=0) ** 2 + np.gradient(h, axis=1) ** 2) for h in surfaces]
    assert 0.85 < np.sqrt(np.mean(squares)) / slope < 1.0


def test_the_spectrum_is_what_was_asked_for():
    shape, spacing = (128, 128), 0.5
    kwargs = {"prefactor": 2.0, "cut_off": 4.0, "roll_off": 16.0}
    power = np.mean(
        [
            abs(np.fft.fft2(band_limited(shape, spacing, 0.7, seed=seed, **kwargs))) ** 2
            for seed in range(20)
        ],
        axis=0,
    )
    density = power * spacing**2 / (shape[0] * shape[1])
    q = 2 * np.pi * np.hypot(*np.meshgrid(*(np.fft.fftfreq(n, spacing) for n in shape)))
    inside = (q > 2 * np.pi / 10) & (q < 2 * np.pi / 5)
    wanted = 2.0 * q[inside] ** (-2 * 1.7)
    # The patch is not periodic: its edges leak into short waves.
    assert np.median(density[inside] / wanted) == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize("cut_off", [1.9, 17.0])
def test_cut_offs_that_no_grid_has_are_refused(cut_off):
    with pytest.raises(ValueError, match="expected two spacings"):
        band_limited((8, 8), 1.0, 0.5, prefactor=1.0, cut_off=cut_off, roll_off=16.0, seed=1)


def test_fudged_area_between_its_limits():
    assert fudged_persson_area(0.3, 1.0, 1.0, 1.0) == pytest.approx(persson_area(0.3, 1.0, 1.0))
    light = float(fudged_persson_area(1e-6, 1.0, 1.0))
    assert light == pytest.approx(linear_area(1e-6, 1.0, 1.0, np.sqrt(8 / np.pi / FUDGE)), rel=1e-4)
    assert fudged_persson_area(3.0, 1.0, 1.0) == pytest.approx(1.0, abs=1e-4)
    areas = fudged_persson_area(np.linspace(0, 1, 20), 1.0, 1.0)
    assert (np.diff(areas) > 0).all()


@pytest.mark.parametrize("pressure", PERIODIC_AREAS)
def test_fudged_area_is_near_published_computations(pressure):
    found = fudged_persson_area(pressure, 1.0, PERIODIC_SLOPE)
    assert found == pytest.approx(PERIODIC_AREAS[pressure], rel=0.08)


def test_states_are_physical(found):
    assert (found["residual"] < 1e-4).all()
    assert (found["corrected_share"] <= found["area_share"]).all()
    # Plateaus of the punch touch as a whole.
    rough = found.isel(surface=found["of_construction"].values != "cantor-punch")
    assert (rough["area_share"].diff("reduced_pressure") > 0).all()
    assert (found["area_share"].diff("reduced_pressure") >= 0).all()
    assert (found["separation"].diff("reduced_pressure") < 0).all()
    assert (found["separation"] > 0).all()
    np.testing.assert_allclose(found["nodes"], found["area_share"] * found["of_size"] ** 2)


def test_longer_cut_offs_leave_more_area(found):
    fine = found.isel(surface=(found["of_arm"] == "R").values)
    cut_offs = fine["of_cut_off"].values
    means = {
        name: np.array([fine[name].values[cut_offs == k].mean(axis=0) for k in (4, 8, 16)])
        for name in ("corrected_share", "rms_slope")
    }
    assert (np.diff(means["corrected_share"], axis=0) > 0).all()
    assert (np.diff(means["rms_slope"]) < 0).all()
    # The resolution law: as h'_rms has it.
    assert abs(found["area_delta"] - found["theory_delta"]).max() < 0.15


def test_everything_is_labelled(found):
    for name, variable in found.variables.items():
        if name not in ("arm", "construction"):
            assert variable.attrs.get("units"), name
            assert variable.attrs.get("long_name"), name


def test_the_order_of_the_parts_does_not_matter(parts, found):
    xr.testing.assert_identical(size_effect_verdict(parts[::-1], RECIPE), found)


def _made(parts, exponent):
    """The parts with areas that go as a power of the side, and with the cut-off as eq. 6 has it."""
    made = []
    for part in parts:
        side = part["of_size"] / 64.0
        fine = part["of_cut_off"] / 4.0
        noise = np.random.default_rng(int(part["number"][0]) + part["of_size"].values[0])
        shape = part["corrected_share"].shape
        area = 0.01 * side ** exponent(part["of_hurst"]) * fine ** (1 - part["of_hurst"])
        values = area.values[:, np.newaxis] * np.exp(noise.normal(0, 0.01, shape))
        made.append(part.assign(corrected_share=(part["corrected_share"].dims, values)))
    return made


@pytest.fixture(scope="module")
def many():
    """Parts with more sides, whose states are not solved again but made."""
    base = {
        "hurst": [0.5, 0.8],
        "loads": [0.01, 0.05, 0.1],
        "cut_off": 8,
        "roll_off": 16,
        "roll_off_fraction": 0.25,
        "arms": {
            "R": {"sizes": [64], "surfaces": [6], "cut_offs": [4, 8, 16]},
            "S1": {"sizes": [64, 128, 256, 512], "surfaces": [10, 10, 10, 10]},
        },
    }
    return base, [_empty(task, base["loads"]) for task in size_tasks(base)]


def _empty(task, loads):
    """States of a job that nobody solved: ones, but for what the class is."""
    from contactlab.experiments import size_states

    shape = (task.surfaces, len(loads))
    values = {
        name: np.ones(shape if len(dims) == 2 else shape[:1])
        for name, (dims, _, _) in (size_states.STATES | size_states.SURFACES).items()
    }
    values |= {
        "of_arm": np.array([task.arm] * task.surfaces),
        "of_hurst": np.full(task.surfaces, task.hurst),
        "of_size": np.full(task.surfaces, task.size),
        "of_cut_off": np.full(task.surfaces, task.cut_off),
        "of_construction": np.array([task.construction] * task.surfaces),
        "number": np.arange(task.first, task.first + task.surfaces),
        "rms_slope": np.full(task.surfaces, float(task.cut_off) ** (task.hurst - 1)),
    }
    tables = size_states.STATES | size_states.SURFACES
    return size_states.labelled_dataset(
        tables, values, {"reduced_pressure": ("reduced_pressure", np.array(loads))}
    )


def test_a_world_in_which_eq_6_is_true_is_recognised(many):
    recipe, parts = many
    # Resolution and size have one exponent, 2 - Delta = 1 - H: finer is as good as larger.
    found = size_effect_verdict(_made(parts, lambda hurst: hurst - 1), recipe)
    assert (found["verdict"] == "eq. 6 agrees").all()
    assert (found["overall"] == "eq. 6 supported").all()
    assert not found["no_size_effect"].any()


def test_a_world_in_which_it_is_false_is_recognised(many):
    recipe, parts = many
    found = size_effect_verdict(_made(parts, lambda hurst: 0 * hurst), recipe)
    assert (found["verdict"] != "eq. 6 agrees").all()
    assert (found["overall"] != "eq. 6 supported").all()
    assert found["no_size_effect"].all()


def test_an_exponent_met_by_chance_at_one_h_supports_nothing(many):
    recipe, parts = many
    found = size_effect_verdict(_made(parts, lambda hurst: 0 * hurst - 0.5), recipe)
    assert (found["verdict"].sel(hurst=0.5) == "eq. 6 agrees").all()
    assert (found["overall"] != "eq. 6 supported").all()
