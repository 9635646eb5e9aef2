"""Error against time: the front, the errors, what is measured of a small problem, growth."""

import os
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from contactlab.accuracy import speed
from contactlab.accuracy.growth import growth
from contactlab.accuracy.reference import hertz_problem, problems_of, punch_problem, rough_problem
from contactlab.accuracy.speed import (
    ERRORS,
    MODELS,
    OURS,
    ahead_of_ours,
    error_against_time,
    errors_of,
    pareto_front,
)
from contactlab.accuracy.timing import peak_memory, repeated
from contactlab.methods.method import Method
from contactlab.methods.peers import PublicCode
from contactlab.methods.registry import METHODS

RECIPE = {
    "sizes": [24, 32],
    "hurst": [0.8],
    "contact": [0.1],
    "seed": 1,
    "tolerances": [1e-1, 1e-6],
    "runs": 3,
    "longest": 5.0,
    "slow_nodes": 400,
}


@pytest.fixture(scope="module")
def problem():
    return problems_of(RECIPE)["n24_h0.8_c10"]()


@pytest.fixture(scope="module")
def points(problem):
    return error_against_time(problem, RECIPE)


# -- the front -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("seconds", "error", "front"),
    [
        ([1, 2, 3], [3, 2, 1], [True, True, True]),
        ([1, 2, 3], [1, 2, 3], [True, False, False]),
        ([1, 1, 2], [2, 1, 1], [False, True, False]),
        ([1, 1], [1, 1], [True, True]),
        ([1, np.nan, 2], [2, 0, np.nan], [True, False, False]),
        ([], [], []),
    ],
)
def test_pareto_front_of_small_sets(seconds, error, front):
    assert pareto_front(seconds, error).tolist() == front


def test_every_point_off_the_front_is_beaten_by_one_on_it():
    seconds, error = np.random.default_rng(0).uniform(size=(2, 50))
    front = pareto_front(seconds, error)
    for s, e in zip(seconds[~front], error[~front], strict=True):
        assert ((seconds[front] <= s) & (error[front] <= e)).any()
    order = np.argsort(seconds[front])
    assert (np.diff(error[front][order]) < 0).all()


def test_others_are_ahead_only_below_the_error_and_on_the_front():
    points = xr.Dataset(
        {
            "method": ("point", np.array([OURS, "a", "b", "c", "d"], dtype=object)),
            "kind": ("point", np.array(["solver"] * 4 + ["model"], dtype=object)),
            "force_error": ("point", [1e-5, 1e-3, 1e-1, 1e-4, 1e-3]),
            "seconds": ("point", [4.0, 3.0, 1.0, 5.0, 2.0]),
        },
        attrs={"resolvable_error": 1e-9},
    )
    assert ahead_of_ours(points)["method"].values.tolist() == ["d"]
    assert ahead_of_ours(points, models=False)["method"].values.tolist() == ["a"]
    alike = points.assign_attrs(resolvable_error=1e-2)
    assert ahead_of_ours(alike, below=1.0)["method"].values.tolist() == ["b", "d"]
    assert ahead_of_ours(points, below=1e-5).sizes["point"] == 0


# -- the test problems -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "problem_of",
    [lambda: rough_problem(40, 0.5, 0.1, 2), lambda: hertz_problem(40), lambda: punch_problem(41)],
    ids=["rough", "hertz", "punch"],
)
def test_reference_is_as_close_to_elimination_as_it_says(problem_of):
    small = problem_of()
    own = small.single.own_error(small.height)
    assert 0 < own < 1e-11
    assert small.eliminated() <= own + 1e-12


def test_surfaces_are_loaded_to_the_fraction_asked_for():
    problem = problems_of(RECIPE)["n32_h0.8_c10"]()
    assert problem.single.fraction == pytest.approx(0.1, abs=1.1 / 32**2 + 0.02 * 0.1)


def test_reference_has_no_error(problem):
    errors = errors_of(problem.single.state, problem.single, 1.5)
    assert errors.keys() == ERRORS.keys()
    assert set(errors.values()) == {0.0}


def test_errors_are_relative_to_the_reference(problem):
    exact = problem.single.state
    off = replace(exact, force=1.1 * exact.force, pressure=1.1 * exact.pressure)
    errors = errors_of(off, problem.single, 1.5)
    assert errors["force_error"] == pytest.approx(0.1)
    assert errors["pressure_error"] == pytest.approx(0.1)
    assert errors["area_error"] == errors["delta_error"] == 0


# -- the measurement -------------------------------------------------------------------------------


def test_every_method_and_model_is_measured(points):
    assert {OURS, *METHODS, *MODELS} <= set(points["method"].values)
    measured = points["said"].values == ""
    assert (points["seconds"].values[measured] > 0).all()
    assert (points["runs"].values[measured] == 3).all()
    assert (points["seconds_low"] <= points["seconds"]).values[measured].all()
    assert (points["seconds"] <= points["seconds_high"]).values[measured].all()


def test_a_tight_tolerance_means_a_small_error(points):
    tight = points["tolerance"] == 1e-6
    for name in (OURS, "polonsky-keer", "gauss-seidel"):
        chosen = (points["method"] == name) & tight
        assert points["force_error"].values[chosen.values].max() < 1e-4


def test_bearing_area_has_an_area_and_no_force(points):
    one = points.isel(point=int(np.flatnonzero(points["method"] == "bearing area")[0]))
    assert np.isnan(one["force_error"])
    assert not one["on_front"]
    assert one["area_error"] > 0


def test_every_variable_is_labelled(points):
    assert all({"units", "long_name"} <= set(v.attrs) for v in points.data_vars.values())


def test_a_slow_method_is_left_out_and_a_slow_way_run_once(problem):
    recipe = {**RECIPE, "slow_nodes": 0, "longest": 1e-9}
    found = error_against_time(problem, recipe)
    assert "dense" not in found["method"].values
    tried = {
        name: found["tolerance"].values[(found["method"] == name).values].tolist()
        for name in (OURS, "polonsky-keer")
    }
    assert tried == {OURS: [1e-1, 1e-6], "polonsky-keer": [1e-1]}
    assert (found["runs"] == 1).all()


def test_runs_are_taken_in_turn():
    seen = []
    calls = [lambda name=name: seen.append(name) for name in "ab"]
    seconds = repeated([*calls, lambda: seen.append("slow")], [0, 0, 9.0], runs=3, longest=1.0)
    assert "".join(seen) == "abab"
    assert [len(one) for one in seconds] == [3, 3, 1]


def test_a_peer_that_crashes_is_a_failure_in_the_table(problem, monkeypatch):
    class Wild(PublicCode):
        def solve(self, load, rtol):
            os.abort()

    wild = Method(name="wild", solver=Wild)
    monkeypatch.setattr(speed, "installed_peers", lambda: {"wild": wild})
    recipe = {**RECIPE, "tolerances": [1e-1], "runs": 1, "slow_nodes": 0}
    found = error_against_time(problem, recipe)
    wild = found.isel(point=np.flatnonzero(found["method"] == "wild"))
    assert wild["said"].values.tolist() == ["crashed: SIGABRT"]
    assert wild["seconds"].isnull().all()


def test_peak_memory_is_what_a_call_takes():
    megabytes = 40
    found = peak_memory(lambda: np.ones(megabytes * 125_000).sum())
    assert 0.9 * megabytes < found / 1e6 < 1.3 * megabytes


def test_peak_memory_of_a_call_that_fails_is_not_known():
    assert np.isnan(peak_memory(lambda: 1 / 0))


# -- growth ----------------------------------------------------------------------------------------


def synthetic_points(size, exponent):
    """Two tolerances, of which only the tighter is close enough."""
    nodes = float(size**2)
    table = {
        "seconds": [1e-3 * nodes**exponent, 1e-2 * nodes**exponent],
        "memory": [8 * nodes, 8 * nodes],
        "force_error": [1e-2, 1e-6],
        "applications": [1, 2],
    }
    points = xr.Dataset({name: ("point", values) for name, values in table.items()})
    points["method"] = ("point", np.array([OURS, OURS], dtype=object))
    points["kind"] = ("point", np.array(["solver", "solver"], dtype=object))
    attrs = {"size": size, "scene": f"{size}, synthetic", "application_seconds": 0.5}
    return points.assign_attrs(attrs)


def test_growth_finds_the_exponent_of_a_power_law():
    found = growth([synthetic_points(size, 1.3) for size in (16, 32, 64)], 1e-4)
    one = found.sel(surface="synthetic", solver=OURS)
    assert one["seconds_exponent"] == pytest.approx(1.3)
    assert one["seconds_exponent_low"] == pytest.approx(1.3)
    assert one["memory_exponent"] == pytest.approx(1)
    assert one["seconds"].values == pytest.approx([1e-2 * n**2.6 for n in (16, 32, 64)])
    assert one["bound"].values.tolist() == [1.0] * 3


def test_growth_says_nothing_of_a_solver_that_never_gets_there():
    found = growth([synthetic_points(size, 1.3) for size in (16, 32, 64)], 1e-9)
    assert found["seconds"].isnull().all()
    assert found["seconds_exponent"].isnull().all()
