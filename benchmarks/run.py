"""Measure the contact solver against other methods and other codes.

    python benchmarks/run.py                     512 x 512 and a small one; 20 minutes with peers
    python benchmarks/run.py --quick             256 x 256: two minutes
    python benchmarks/run.py --sizes 512 --every-solver --every-sweep --scaling     hours
    python benchmarks/run.py --sizes --scaling 256 512 1024 2048 --huge             ours alone

The tables of a run replace those of the last one in its ``--output``.

Every solver runs in this process on the same test problem, in turn, each at the loosest tolerance
that brings its force within 1e-6 of a reference solved to 1e-12, at every load of a sweep with the
same one (what misses it, or says itself that it failed, has no time); ours also at its default
tolerance, or a tighter one where that leaves a larger error. The first problem of each size is
measured with every solver, and over a sweep of 16 loads with ours and the fastest of the peers; the
others with these two, one load. What is set up once for a grid (kernel, transform plans) is not
timed, for anybody; ours keeps nothing of the solve before. Peers are taken in where they are
installed: ``make bench PEERS=1``; ASPHER where it builds, and its set-up cannot be told from its
solve. ``path`` says by counters which way each call went. Ours uses as many threads as
OMP_NUM_THREADS says, or as there are cores; the peers' packages have one.
"""

import argparse
import csv
import os
import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from itertools import product
from math import isfinite
from pathlib import Path


def main():
    """Measure what the command line asks for and write the tables."""
    options = _options()
    # Read by BLAS when numpy is imported, hence the imports below: two of its threads waiting make
    # a peer's L-BFGS-B four times slower.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    from measure import measure_huge, measure_scaling

    from contactlab.accuracy.reference import RoughProblem

    rows, remarks, scaling, huge = [], [], [], []
    for size in options.sizes:
        for number, (hurst, fraction) in enumerate(product(options.hurst, options.fractions)):
            problem = RoughProblem(size, hurst, fraction, options.seed)
            difference = problem.eliminated()
            if isfinite(difference):
                remarks.append(f"{problem.name}: reference and elimination {difference:.1e}")
            rows += _problem_rows(problem, options, first=number == 0)
            _write(options.output, rows, remarks, scaling, huge)
    for hurst in options.hurst if options.scaling else []:
        _say(f"scaling, H = {hurst:g} ...")
        scaling += measure_scaling(
            options.scaling, hurst=hurst, fraction=0.18, seed=options.seed, runs=options.runs
        )
        _write(options.output, rows, remarks, scaling, huge)
    if options.huge:
        _say("4096 ...")
        huge.append(measure_huge(4096, hurst=0.8, fraction=0.05, seed=options.seed))
    sys.stdout.write(_write(options.output, rows, remarks, scaling, huge))


def _problem_rows(problem, options, *, first):
    """Rows of the table of solvers on a problem; most on the ``first`` of its size."""
    from measure import measure_cold, measure_sweep
    from solvers import solvers_for

    wanted = {"methods": options.methods, "peers_wanted": options.peers}
    _say(f"{problem.name}, cold ...")
    solvers = solvers_for(problem, every=first or options.every_solver, **wanted)
    rows = measure_cold(problem, solvers, runs=options.runs)
    if options.sweep and (first or options.every_sweep):
        _say(f"{problem.name}, sweep ...")
        solvers = solvers_for(problem, every=options.every_solver, **wanted)
        rows += measure_sweep(problem, solvers, runs=options.runs)
    return rows


def _options():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--sizes", type=int, nargs="*", default=[64, 512], help="nodes per side")
    add("--hurst", type=float, nargs="+", default=[0.8, 0.5])
    add("--fractions", type=float, nargs="+", default=[0.07, 0.02, 0.18], help="in contact")
    add("--runs", type=int, default=5, help="of each solver, in turn")
    add("--seed", type=int, default=1)
    add("--scaling", type=int, nargs="*", default=[256, 512, 1024], help="sizes, ours alone")
    add("--huge", action="store_true", help="4096 x 4096, 5 %% in contact, with peak memory")
    add("--every-solver", action="store_true", help="all of them on every problem and sweep")
    add("--every-sweep", action="store_true", help="a sweep of every problem")
    add("--no-sweep", dest="sweep", action="store_false")
    add("--no-methods", dest="methods", action="store_false")
    add("--peers", nargs="+", metavar="NAME", help="of the installed codes these alone")
    add("--no-peers", dest="peers", action="store_const", const=[])
    add("--quick", action="store_true", help="256 x 256 and a small one, scaling to 512")
    add("--output", type=Path, default=Path("results/benchmarks"), help="folder of the tables")
    options = parser.parse_args()
    if options.quick:
        options.sizes, options.scaling, options.runs = [64, 256], [256, 512], 3
    return options


def _say(text):
    sys.stderr.write(text + "\n")


def _write(folder, rows, remarks, scaling, huge):
    """Tables in Markdown and CSV; returns the Markdown."""
    folder.mkdir(parents=True, exist_ok=True)
    parts = [_versions()]
    for name, table in (("solvers", rows), ("scaling", scaling), ("huge", huge)):
        if table:
            columns = list(dict.fromkeys(column for row in table for column in row))
            with (folder / f"{name}.csv").open("w", newline="") as file:
                writer = csv.DictWriter(file, columns)
                writer.writeheader()
                writer.writerows(table)
            parts.append(_markdown(columns, table))
    lines = _verdict(rows) + [f"- {remark}" for remark in remarks]
    if lines:
        parts.append("\n".join(lines))
    text = "\n\n".join(parts) + "\n"
    (folder / "benchmarks.md").write_text(text)
    return text


def _versions():
    from contactlab.methods.registry import PEERS
    from roughcontact.threads import count

    packages = ["fractalcontact", "numpy", "scipy", "numba"]
    packages += dict.fromkeys(package for peer in PEERS.values() for package in peer.packages)
    named = []
    for package in packages:
        try:
            named.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            named.append(f"{package} not installed")
    running = f"Python {platform.python_version()}, {os.cpu_count()} cores, {count()} threads"
    return f"{running}; " + ", ".join(named)


def _markdown(columns, table):
    lines = ["| " + " | ".join(columns) + " |", "|" + " --- |" * len(columns)]
    lines += ["| " + " | ".join(_cell(row.get(c)) for c in columns) + " |" for row in table]
    return "\n".join(lines)


def _cell(value):
    if value is None:
        return ""
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def _verdict(rows):
    """For every problem and loading: the fastest public code against ours, both given the same."""
    from contactlab.methods.registry import PEERS

    lines = []
    problems = dict.fromkeys((r["size"], r["hurst"], r["contact"], r["loading"]) for r in rows)
    for key in problems:
        here = [
            r
            for r in rows
            if (r["size"], r["hurst"], r["contact"], r["loading"]) == key and "ratio" in r
        ]
        peers = [r for r in here if r["solver"].removesuffix(f" ({r['control']})") in PEERS]
        if not peers:
            continue
        peer = min(peers, key=lambda r: r["seconds"])
        size, hurst, contact, loading = key
        # Not every code lets its work be counted.
        work = f" and {peer['applications']:g} applications" if "applications" in peer else ""
        lines.append(
            f"- {size}, H = {hurst:g}, {100 * contact:.1f} % in contact, {loading}:"
            f" {peer['solver']} is the fastest public code here, {peer['seconds']:.3g} s{work};"
            f" ours by {peer['control']} is {peer['ratio']:.1f} times faster"
        )
    return lines


if __name__ == "__main__":
    main()
