"""What each part of the contact solver gains, measured by leaving it out.

    python benchmarks/solver_gains.py                    256, 512 and 1024 nodes per side; minutes
    python benchmarks/solver_gains.py --sizes 256        cold solves and load steps, seconds
    python benchmarks/solver_gains.py --sizes 1024 --runs 5

Every problem is solved by the whole solver and once without each of its parts, which
packages/roughcontact/docs/solver_parts.md describes. All solves are to the same tolerance under a
given closure: cold, or as the last step of a load sweep. The script counts applications of the
elastic operator, on the grid itself, and on coarser grids as fractions of one there by area. They
are exact; seconds are the median of the runs, and mean little where anything else runs on the
machine. The table replaces
that of the last run in ``--output``. As many threads are used as OMP_NUM_THREADS says, or as there
are cores.

Problems of one hard kind, forces just below what a window carries at its hardness, are also solved
without the closure of a projected step, without safeguards against cycling, and without either: how
many are solved, and in how many applications.
"""

import argparse
import csv
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from unittest import mock

import numpy as np
from scipy import fft

from fractalcontact import ContactState, HalfSpace, NotConverged, solve_contact
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact import (
    active_set,
    coarse_correction,
    full_approximation,
    operator,
    preconditioner,
    projected_cg,
    safeguards,
    solve,
)

WHOLE = "whole solver"
#: Iterations after which a solver without one of its parts is given up.
MOST_ITERATIONS = 40
#: Closures of the steps before, as fractions of the last.
SWEEP = (0.7, 0.85)
#: The contact fraction is met to this.
FRACTION_ERROR = 0.02
COLUMNS = (
    *("size", "hurst", "contact", "loading", "without"),
    *("applications", "coarse", "seconds", "applications ratio", "seconds ratio"),
)


class Identity:
    """No preconditioner: each node by its influence on itself alone."""

    def __init__(self, space: HalfSpace):
        self.small = max(space.shape) <= preconditioner.SMALL
        self._own = np.float32(space.influence()[0, 0])

    def update(self, nodes: np.ndarray, *, fresh: bool) -> None:
        """There is nothing that depends on the set."""

    def __call__(self, residual: np.ndarray) -> np.ndarray:
        """The residual over the influence of a node on itself."""
        return residual / self._own


def _uniform(problem):
    return problem.bounds.clip(np.ones(problem.clearance.size))


_CLIPPED_STEP = projected_cg.ProjectedCG.clipped_step


def _unclipped_step(equations, start, bounds, total):
    _CLIPPED_STEP(equations, start, active_set.UNBOUNDED, total)


def _factor_alone(correction, residual, inverse):
    return inverse(residual)


@cache
def _spectrum(space, dtype):
    """Padded lengths and spectrum of the influence, which is real: it is even."""
    padded = [fft.next_fast_len(2 * n - 1, real=True) for n in space.shape]
    y, x = (np.arange(1 - n, n) for n in space.shape)
    circulant = np.zeros(padded)
    circulant[y[:, None], x] = space.influence()[np.abs(y)[:, None], np.abs(x)]
    return padded, fft.rfft2(circulant).real.astype(dtype)


def _convolve_by_scipy(space, values):
    """The operator by scipy.fft, which is not given the rows of zeros."""
    (ny, nx), (padded, spectrum) = space.shape, _spectrum(space, values.dtype)
    image = fft.fft(fft.rfft(values, padded[1]), padded[0], axis=-2)
    image *= spectrum
    return fft.irfft(fft.ifft(image, axis=-2)[..., :ny, :], padded[1])[..., :nx]


#: What is left out of a cold solve, and what is put in its place: (owner, name, value).
COLD = {
    "transforms of its own": [(HalfSpace, "convolve", _convolve_by_scipy)],
    "preconditioner": [(operator, "preconditioner", Identity)],
    "coarse correction": [
        (coarse_correction.CoarseCorrection, "update", lambda self, nodes, fresh: None),
        (coarse_correction.CoarseCorrection, "balance", _factor_alone),
    ],
    "clipping of the steps": [(projected_cg.ProjectedCG, "clipped_step", _unclipped_step)],
    "nested iteration": [(solve, "nested_iteration_start", _uniform)],
}
#: The same of a step of a load sweep.
STEPS = {
    "set prediction": [(active_set, "SET_PREDICTIONS", 0)],
    "full approximation scheme": [(full_approximation, "MIN_FINE_SIDE", np.inf)],
}


#: Never thought to cycle; and the closure of an iterate left as it is.
SAFEGUARDS = [(safeguards, name, np.inf) for name in ("PATIENCE", "STALL")]
PROJECTED_STEP = [(active_set, "closure_of_step", lambda problem, iterate: iterate.closure)]
YIELD_PARTS = {
    "by the whole solver": [],
    "without projected steps": PROJECTED_STEP,
    "without safeguards": SAFEGUARDS,
    "without either": PROJECTED_STEP + SAFEGUARDS,
}
#: Problems of the hard kind that are tried.
YIELDING = 20


@dataclass
class RoughProblem:
    """A self-affine surface under a closure.

    Attributes
    ----------
    size : int
        Nodes per side.
    hurst, fraction : float
        Hurst exponent, and the contact fraction reached.
    height : (size, size) ndarray
        mm.
    space : HalfSpace
    closure : float
        mm.
    """

    size: int
    hurst: float
    fraction: float
    height: np.ndarray
    space: HalfSpace
    closure: float


def main() -> None:
    """Measure what the command line asks for, print the table and write it."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sizes", type=int, nargs="+", default=[256, 512, 1024])
    parser.add_argument("--hurst", type=float, nargs="+", default=[0.5, 0.8])
    parser.add_argument("--fractions", type=float, nargs="+", default=[0.05, 0.15])
    parser.add_argument("--rtol", type=float, default=1e-6)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--output", type=Path, default=Path("results/benchmarks"))
    options = parser.parse_args()
    rows: list[dict] = []
    for size, hurst, fraction in product(options.sizes, options.hurst, options.fractions):
        sys.stderr.write(f"{size}, H = {hurst:g}, {fraction:.0%} in contact ...\n")
        problem = rough_problem(size, hurst, fraction, options.seed)
        rows += measured(problem, "cold", COLD, options.rtol, options.runs)
        rows += measured(problem, "step", _steps_of(size), options.rtol, options.runs)
        write_table(options.output, rows)
    sys.stdout.write((options.output / "solver_gains.md").read_text(encoding="utf-8"))
    for name, changes in YIELD_PARTS.items():
        with left_out(changes):
            states = [_yielding_state(draw) for draw in range(YIELDING)]
        needed = [state.iterations for state in states if state is not None]
        mean = f"{np.mean(needed):.0f} applications each" if needed else "none"
        sys.stdout.write(f"{len(needed)} of {YIELDING} yielding problems solved {name}: {mean}\n")


def _steps_of(size):
    """Parts that act on load steps in a window of a size."""
    if size >= full_approximation.MIN_FINE_SIDE:
        return STEPS
    return {name: how for name, how in STEPS.items() if name != "full approximation scheme"}


def rough_problem(size: int, hurst: float, fraction: float, seed: int) -> RoughProblem:
    """A self-affine surface and the closure at which a fraction of its nodes touch."""
    height = self_affine((size, size), 1 / size, hurst, rms=0.01, seed=seed)
    space = HalfSpace(height.shape, (1 / size, 1 / size), 1.0)
    low, high, closure = 0.0, np.inf, float(height.std())
    while True:
        state = solve_contact(height, space, closure=closure, rtol=1e-4)
        reached = float(state.in_contact.mean())
        if abs(reached / fraction - 1) <= FRACTION_ERROR:
            return RoughProblem(size, hurst, reached, height, space, closure)
        low, high = (closure, high) if reached < fraction else (low, closure)
        closure = (low + min(high, 4 * low)) / 2


def measured(
    problem: RoughProblem, loading: str, parts: dict[str, list], rtol: float, runs: int
) -> list[dict]:
    """Rows of the table: a problem with the whole solver, and without each of some parts."""
    start = None
    if loading == "step":
        for factor in SWEEP:
            closure = factor * problem.closure
            start = solve_contact(problem.height, problem.space, closure=closure, start=start)
    rows = []
    for name, changes in {WHOLE: [], **parts}.items():
        row = {
            "size": problem.size,
            "hurst": problem.hurst,
            "contact": round(problem.fraction, 3),
            "loading": loading,
            "without": "" if name == WHOLE else name,
        }
        seconds = []
        for _ in range(runs):
            preconditioner.forget_preconditioner(problem.space)
            limit = [(active_set, "MAX_ITERATIONS", MOST_ITERATIONS)]
            with left_out(changes + limit), coarse_applications(problem.space.shape) as coarse:
                begin = time.perf_counter()
                state = _solved(problem, start, rtol)
                seconds.append(time.perf_counter() - begin)
        preconditioner.forget_preconditioner(problem.space)
        if state is not None:
            row |= {"applications": state.iterations, "coarse": round(coarse[0], 2)}
            row["seconds"] = float(np.median(seconds))
            for what in ("applications", "seconds"):
                row[f"{what} ratio"] = row[what] / (rows[0][what] if rows else row[what])
        rows.append(row)
    return rows


def _yielding_state(draw: int) -> ContactState | None:
    """State under a force at which all but the whole window yields; None if it is given up."""
    generator = np.random.default_rng([50, draw])
    ny, nx = generator.integers(20, 33, size=2)
    height = self_affine((32, 32), 0.1, 0.8, rms=0.1, seed=draw)[:ny, :nx]
    space = HalfSpace((int(ny), int(nx)), (0.1, 0.1), 1e4)
    hardness = 10 ** generator.uniform(0, 3)
    force = hardness * height.size * space.cell_area * (1 - 10 ** generator.uniform(-6, -1))
    try:
        return solve_contact(height, space, force=force, hardness=hardness)
    except NotConverged:
        return None


def _solved(problem, start, rtol) -> ContactState | None:
    try:
        return solve_contact(
            problem.height, problem.space, closure=problem.closure, start=start, rtol=rtol
        )
    except NotConverged:
        return None


@contextmanager
def left_out(changes: list[tuple[object, str, object]]) -> Iterator[None]:
    """Put other values in the place of what some modules and classes have."""
    with ExitStack() as stack:
        for owner, name, value in changes:
            stack.enter_context(mock.patch.object(owner, name, value))
        yield


@contextmanager
def coarse_applications(shape: tuple[int, int]) -> Iterator[list[float]]:
    """Count what is convolved meanwhile on other grids, as fractions of one by area."""
    total, convolve = [0.0], HalfSpace.convolve

    def counted(space: HalfSpace, values: np.ndarray) -> np.ndarray:
        if space.shape != shape:
            total[0] += values.size / (shape[0] * shape[1])
        return convolve(space, values)

    with mock.patch.object(HalfSpace, "convolve", counted):
        yield total


def write_table(folder: Path, rows: list[dict]) -> None:
    """Write solver_gains.csv, and the same for reading as solver_gains.md."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "solver_gains.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    lines = [
        "| size | H | contact | loading | without | applications | on coarser grids | time, s |",
        "|---:|---:|---:|---|---|---:|---:|---:|",
    ]
    for row in rows:
        head = f"| {row['size']} | {row['hurst']:g} | {row['contact']:.1%} | {row['loading']} "
        head += f"| {row['without'] or WHOLE} "
        if "applications" not in row:
            lines.append(head + "| not converged | | |")
            continue
        ratios = [f" (x {row[f'{what} ratio']:.2g})" for what in ("applications", "seconds")]
        if not row["without"]:
            ratios = ["", ""]
        lines.append(
            head + f"| {row['applications']}{ratios[0]} | {row['coarse']:g} "
            f"| {row['seconds']:.3g}{ratios[1]} |"
        )
    (folder / "solver_gains.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
