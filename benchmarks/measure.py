"""Tuning, counting and timing: every solver in turn, on one test problem, to the same error."""

import json
import resource
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np
from solvers import Failed, counted_convolutions, forget

from contactlab.accuracy.reference import LOADS, RoughProblem, closure_at_fraction
from fractalcontact import HalfSpace, solve_contact

# Force error every solver has to reach.
ERROR = 1e-6
# Tolerances are tried in these steps, as far as this.
STEP = 10**0.5
TIGHTEST = 1e-10


def measure_cold(problem, solvers, *, runs):
    """Rows of the table for single solves of one problem."""
    return _measure(problem, solvers, [problem.single], "cold", runs)


def measure_sweep(problem, solvers, *, runs):
    """Rows of the table for a sweep, of the solvers that can start from the load before."""
    sweepers = [solver for solver in solvers if solver.runs_sweep]
    return _measure(problem, sweepers, problem.sweep, "sweep", runs)


def _measure(problem, solvers, references, loading, runs):
    rows, ready = [], []
    for solver in solvers:
        row = {
            "size": problem.size,
            "hurst": problem.hurst,
            "contact": round(references[-1].fraction, 4),
            "loading": loading,
            "solver": solver.name,
            "control": solver.control,
        }
        row |= _tune(solver, references)
        rows.append(row)
        if row["tolerance"] is not None:
            ready.append((solver, row))
    seconds = {solver.name: [] for solver, _ in ready}
    for _ in range(runs):
        for solver, row in ready:
            begin = time.perf_counter()
            _press(solver, references, row["tolerance"])
            seconds[solver.name].append(time.perf_counter() - begin)
    for solver, row in ready:
        row["seconds"] = float(np.median(seconds[solver.name]))
        ours = f"fractalcontact ({solver.control})"
        if ours in seconds:
            ratios = np.array(seconds[solver.name]) / np.array(seconds[ours])
            row["ratio"] = float(np.median(ratios))
    return rows


def _press(solver, references, tolerance):
    """Solve the loads in order, each from the state before."""
    previous = None
    for reference in references:
        previous = solver.solve(reference, tolerance, previous)


def _tune(solver, references):
    """The loosest tolerance that reaches `ERROR` at every load, and the work it takes.

    Searched from the solver's likely one, as a trial of a peer's sweep may take minutes.
    """
    solver.counting = True
    row = _try(solver, references, solver.likely)
    tolerance, reached = solver.likely, row["tolerance"] is not None
    while reached and tolerance * STEP <= solver.loosest:
        tolerance *= STEP
        looser = _try(solver, references, tolerance)
        if looser["tolerance"] is None:
            break
        row = looser
    while not reached and tolerance / STEP >= TIGHTEST:
        tolerance /= STEP
        row = _try(solver, references, tolerance)
        reached = row["tolerance"] is not None
    solver.counting = False
    return row


def _try(solver, references, tolerance):
    """Errors and work at one tolerance, as far as the first load at which it is too loose."""
    errors, work, coarse, previous = [], [], [], None
    for reference in references:
        try:
            previous = solver.solve(reference, tolerance, previous)
        except Failed as failure:
            return {"tolerance": None, "note": str(failure)}
        solver.complete(previous)
        errors.append(float(reference.error(previous)))
        if not errors[-1] <= ERROR:
            return {"tolerance": None, "note": f"too far off at {tolerance:.2g}: {errors[-1]:.2g}"}
        work.append(solver.applications())
        coarse.append(solver.coarse_applications())
    row = {"tolerance": tolerance, "note": "", "error": max(errors), "path": solver.path()}
    return row | _work(work, coarse)


def _work(work, coarse):
    """Applications, where a solver counts them: of the only solve, or mean and most of the warm."""
    if work[0] is None:
        return {}
    if len(work) > 1:
        work, coarse = work[1:], coarse[1:]
    return {
        "applications": round(float(np.mean(work)), 1),
        "most": max(work),
        "coarse": round(float(np.mean(coarse)), 2),
    }


def measure_scaling(sizes, *, hurst, fraction, seed, runs):
    """Ours alone over sizes: cold and warm, and the cost beyond the transforms'."""
    rows = []
    for size in sizes:
        problem = RoughProblem(size, hurst, fraction, seed)
        space, closure = problem.space, problem.closure
        state, applications, coarse = _counted(problem, closure)
        seconds = _median_seconds(partial(_cold, problem, closure), runs)
        convolution = _median_seconds(partial(space.convolve, np.zeros(space.shape)), runs)
        warm, warm_seconds = _own_sweep(problem)
        rows.append(
            {
                "size": size,
                "hurst": hurst,
                "contact": round(np.count_nonzero(state.in_contact) / problem.height.size, 4),
                "seconds": seconds,
                "applications": applications,
                "coarse": round(coarse, 2),
                "warm seconds": warm_seconds,
                "warm applications": round(float(np.mean(warm)), 1),
                "most": max(warm),
                "microseconds per node": 1e6 * seconds / problem.height.size,
                "one convolution": convolution,
                "solve in convolutions": seconds / convolution,
            }
        )
        growth = rows[-1]["solve in convolutions"] / rows[0]["solve in convolutions"]
        rows[-1]["growth beyond FFT"] = growth
    return rows


def _cold(problem, closure):
    forget(problem.space)
    return solve_contact(problem.height, problem.space, closure=closure)


def _counted(problem, closure, start=None):
    """A state, the full applications it took, and the coarse ones as fractions of a full one."""
    if start is None:
        forget(problem.space)
    with counted_convolutions(problem.space.shape) as calls:
        state = solve_contact(problem.height, problem.space, closure=closure, start=start)
    return state, max(state.iterations, calls["full"]), calls["coarse"]


def _own_sweep(problem):
    """Applications of every warm solve of a sweep, and their mean seconds."""
    state = _cold(problem, problem.closure / LOADS)
    applications, begin = [], time.perf_counter()
    for step in range(2, LOADS + 1):
        state, count, _ = _counted(problem, problem.closure * step / LOADS, state)
        applications.append(count)
    return applications, (time.perf_counter() - begin) / (LOADS - 1)


def _median_seconds(function, runs):
    function()
    seconds = []
    for _ in range(runs):
        begin = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - begin)
    return float(np.median(seconds))


def measure_huge(size, *, hurst, fraction, seed):
    """Time and peak memory of a cold solve, in a process that reads the surface from a file."""
    with tempfile.TemporaryDirectory() as folder:
        for step in ("make", "solve"):
            command = [sys.executable, __file__, step, folder, size, hurst, fraction, seed]
            done = subprocess.run(
                [str(part) for part in command], check=True, stdout=subprocess.PIPE, text=True
            )
    return json.loads(done.stdout)


def _make(folder, size, hurst, fraction, seed):
    problem = RoughProblem(size, hurst, fraction, seed)
    closure = closure_at_fraction(problem.height, problem.space, fraction)
    np.save(folder / "height.npy", problem.height, allow_pickle=False)
    (folder / "closure.json").write_text(json.dumps(closure))


def _solve(folder, size, hurst, _fraction, _seed):
    height = np.load(folder / "height.npy", allow_pickle=False)
    closure = json.loads((folder / "closure.json").read_text())
    begin = time.perf_counter()
    state = solve_contact(
        height, HalfSpace(height.shape, (1 / size, 1 / size), 1.0), closure=closure
    )
    row = {
        "size": size,
        "hurst": hurst,
        "contact": round(np.count_nonzero(state.in_contact) / height.size, 4),
        "seconds": time.perf_counter() - begin,
        "applications": state.iterations,
        # Linux counts in KiB, the BSDs in bytes.
        "peak GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        * (1 if sys.platform == "darwin" else 1024)
        / 1e9,
    }
    sys.stdout.write(json.dumps(row))


if __name__ == "__main__":
    step, folder, size, hurst, fraction, seed = sys.argv[1:]
    {"make": _make, "solve": _solve}[step](
        Path(folder), int(size), float(hurst), float(fraction), int(seed)
    )
