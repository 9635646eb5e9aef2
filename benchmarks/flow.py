"""Time and memory of the local cubic law beside reynoldsflow, on one thread.

`make bench-flow PEERS=1`. Both get the same field, in turn, each in a process of its own: filtered
noise with contact, the part that percolates along the flow solved. reynoldsflow is periodic across
the flow; a row of contact along that side makes its equations those of walls.
"""

import argparse
import importlib.util
import os
import resource
import statistics
import subprocess
import sys
import time

THREADS = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMBA")}
SOLVERS = ("cholmod", "superlu", "scipy.amg-rs", "scipy.amg-smooth_aggregation", "scipy-spsolve")
#: Solvers of ours; the others are those of reynoldsflow that install as wheels.
OURS = {"cholmod": True, "superlu": False}
#: What must be installed for each.
NEEDED = {"cholmod": "cvxopt", "superlu": "scipy"}


def field(n, seed=1):
    """Gaps (n, n): filtered noise and contact, walled off along one side."""
    import numpy as np
    from scipy import ndimage

    noise = np.random.default_rng(seed).normal(size=(n, n))
    heights = ndimage.gaussian_filter(noise, n / 48, mode="wrap")
    gap = np.clip(heights.T / heights.std() + 0.35, 0, None)
    gap[gap < 1e-3 * gap.mean()] = 0
    gap[:, 0] = 0
    return gap


def by_ours(gap, cholmod):
    """Transmissivity along y, and the bound on its error."""
    from fractalcontact.flow import red_black
    from fractalcontact.flow.cubic_law import plane_flow

    if not cholmod:
        red_black.cvxopt = None
    # Both codes take harmonic means.
    flow = plane_flow(gap, (1.0, 1.0), "y", faces="harmonic")
    return flow.transmissivity, flow.imbalance


def by_reynoldsflow(gap, solver):
    """The same by reynoldsflow, with its own error of conservation."""
    from reynoldsflow.transport import compute_total_flux, solve_fluid_problem

    kept, _, flux = solve_fluid_problem(gap, solver=solver)
    total, error = compute_total_flux(kept, flux, len(gap))
    return total / 12, error


def measure(n, solver):
    """Solve one field with one solver and write its numbers; compiled on a small field before."""
    ours = solver in OURS
    solve = by_ours if ours else by_reynoldsflow
    how = OURS[solver] if ours else solver
    solve(field(64), how)
    gap = field(n)
    start, busy = time.perf_counter(), time.process_time()
    value, error = solve(gap, how)
    seconds, busy = time.perf_counter() - start, time.process_time() - busy
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9
    sys.stdout.write(f"{seconds} {busy} {peak} {value:.10e} {error:.1e}\n")


def measured(n, solver):
    """What one process of its own writes of a solver: numbers in words."""
    command = [sys.executable, __file__, "--measure", str(n), solver]
    taken = subprocess.run(command, check=True, stdout=subprocess.PIPE, env=os.environ | THREADS)
    return taken.stdout.decode().split()


def main(arguments):
    """Measure every solver that is installed, in turn, and write medians."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", nargs="+", type=int, default=[512, 1024, 2048])
    parser.add_argument("--solvers", nargs="+", choices=SOLVERS, default=list(SOLVERS))
    parser.add_argument("--repeats", type=int, default=7, help="of each, in turn: medians")
    parser.add_argument("--measure", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.measure:
        measure(int(options.measure[0]), options.measure[1])
        return
    solvers = [
        solver
        for solver in options.solvers
        if importlib.util.find_spec(NEEDED.get(solver, "reynoldsflow"))
    ]
    sys.stdout.write(
        " nodes code            solver                         seconds    CPU s  peak GB"
        " T (mm3)              balance\n"
    )
    for n in options.sizes:
        rows = [[measured(n, solver) for solver in solvers] for _ in range(options.repeats)]
        for solver, runs in zip(solvers, zip(*rows, strict=True), strict=True):
            code = "fractalcontact" if solver in OURS else "reynoldsflow"
            times = " ".join(
                f"{statistics.median(map(float, column)):8.3f}"
                for column in list(zip(*runs, strict=True))[:3]
            )
            sys.stdout.write(f"{n:6} {code:15} {solver:29} {times} {' '.join(runs[0][3:])}\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
