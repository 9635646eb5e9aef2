"""Ours beside ASPHER over sizes and contact fractions, in pairs timed in turn.

    python benchmarks/beside_peers.py        512 to 4096, seven fractions, 1 and 2 threads: hours
    python benchmarks/beside_peers.py --sizes 512 --fractions 0.5 8 --threads 1 --pairs 3
    python benchmarks/beside_peers.py --alone --sizes 2048 4096 8192 --fractions 0.05 0.5

Each cell of the table is one self-affine surface under the force at which a fraction of it touches,
solved by ours and by every mode of the peer at a tolerance of 1e-6, each in a process of its own
with that many threads. Ours is timed in turn with the peer, twice: with what belongs to the grid
(kernel, transforms, operator between blocks) made anew in each solve, which is what the peer always
does, and with that kept. Compiled kernels are loaded before, for both. One thread is compared by
processor time, several by the clock. A ratio of times has its 95 % interval over the pairs, if more
than one is worth waiting for.

An answer is judged before its time is read: by the closure that its pressure has under a
convolution in double precision, against one of ours to 1e-8, and by its force (in windows of more
than 4096 nodes along a side by the force alone). Beyond ``--error`` the row is disqualified; so is
a peer that says that it failed, or takes longer than ``--limit``.
``path`` are the counters that prove which way the last call went. Peak memory is that of the whole
process, which holds the surface and, of the peer, what it is given and gives.

Tables beside_peers.csv and .md go to ``--output``, after each cell; cells that are there are not
measured again, so that a run that was ended goes on. The last lines are how time and memory grow
with the nodes at each fraction: exponents of power laws, with standard errors.
"""

import argparse
import csv
import json
import os
import select
import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np

HURST, RMS, RTOL = 0.8, 0.02, 1e-6
#: The fraction in contact is met to this: it names a cell and decides nothing.
MET = 0.05
#: Windows with more nodes along a side have single precision heights in a file mapped to memory.
MAPPED = 4096
#: Of more nodes along a side the surface is made in single precision too: in double, 16384 nodes
#: along a side take more than 22 GB.
LARGEST_IN_DOUBLE = 8192
OURS = ("with set-up", "without")
PEERS = ("ASPHER active set", "ASPHER fft")
#: Seconds to load a surface and to judge an answer, beside those of the solve.
JUDGING = 60
TOO_LONG, BEYOND = "longer than", "not tried: too long with fewer nodes or less contact"
COLUMNS = (
    *("size", "contact", "threads", "solver", "seconds", "ours", "times", "low", "high", "pairs"),
    *("error", "note", "applications", "path", "peak GB"),
)


def main():
    """Measure what the command line asks for, and write the tables."""
    options = _options()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = _read(options.output)
    known = {(row["size"], row["contact"], row["threads"]) for row in rows}
    wanted = list(product(options.sizes, options.fractions, options.threads))
    for size, percent, threads in wanted:
        if (str(size), f"{percent:g}", str(threads)) in known:
            continue
        sys.stderr.write(f"{size}, {percent:g} % in contact, {threads} threads ...\n")
        rows += _cell(size, percent, threads, options, rows)
        _write(options.output, rows)
    sys.stdout.write(_write(options.output, rows))


def _options():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--sizes", type=int, nargs="+", default=[512, 1024, 2048, 4096], help="nodes per side")
    add("--fractions", type=float, nargs="+", default=[0.004, 0.05, 0.5, 2, 8, 20, 60], help="%%")
    add("--threads", type=int, nargs="+", default=[1, 2])
    add("--pairs", type=int, default=5, help="most of each cell")
    add("--patience", type=float, default=60, help="no further pair after this many seconds")
    add("--limit", type=float, default=600, help="of one solve, seconds")
    add("--error", type=float, default=1e-5, help="of closure or force, relative, at most")
    add("--peers", nargs="+", default=list(PEERS))
    add("--alone", dest="peers", action="store_const", const=[], help="ours only")
    add("--seed", type=int, default=1)
    add("--output", type=Path, default=Path("results/benchmarks"))
    add("--work", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work:
        _work(json.loads(options.work))
        sys.exit()
    return options


# What measures.


def _cell(size, percent, threads, options, before):
    """Rows of one cell: ours with and without set-up, and every mode of the peer.

    A mode that took too long ``before``, of no more nodes or contact, is not tried again.
    """
    load = _load(size, percent, options)
    row = {"size": size, "contact": f"{percent:g}", "threads": threads}
    names = [*OURS, *(p for p in options.peers if "ASPHER" not in p or size & (size - 1) == 0)]
    rows, answers = [], {}
    for name in [name for name in names if _beyond(name, size, percent, threads, before)]:
        rows.append(row | {"solver": name, "note": BEYOND})
        names.remove(name)
    workers = {name: _Worker(name, load, threads, options.limit) for name in names}
    for name, worker in workers.items():
        answers[name] = worker.solve(warm=True)
    for name in names:
        if name in OURS:
            continue
        rows.append(row | _against(name, workers, answers, load, threads, options))
    for name in OURS:
        times = [_time(workers[name].solve(), threads) for _ in range(options.pairs)]
        found = answers[name]
        rows.append(
            row
            | {"solver": f"ours, {name}", "seconds": float(np.median(times)), "pairs": len(times)}
            | _judged(found, load, options)
        )
    for worker in workers.values():
        worker.end()
    return rows


def _beyond(name, size, percent, threads, rows):
    """Whether a solver took too long in a cell of no more nodes and no more contact."""
    return any(
        row["solver"] == name
        and int(row["size"]) <= size
        and float(row["contact"]) <= percent
        and int(row["threads"]) >= threads
        and str(row.get("note", "")).startswith((TOO_LONG, BEYOND))
        for row in rows
    )


def _against(name, workers, answers, load, threads, options):
    """The row of a mode of the peer, in turn with ours with its set-up."""
    row = {"solver": name} | _judged(answers[name], load, options)
    if row["note"]:
        return row
    # One pair is enough, without an interval, where the first solve tries the patience.
    pairs, spent = [], answers[name]["clock"]
    least = 1 if spent > options.patience else 2
    while len(pairs) < least or (len(pairs) < options.pairs and spent < options.patience):
        order = [OURS[0], name] if len(pairs) % 2 else [name, OURS[0]]
        pair = {who: workers[who].solve() for who in order}
        if any("failed" in found for found in pair.values()):
            return row | {"note": "failed in a later run"}
        pairs.append([_time(pair[who], threads) for who in (name, OURS[0])])
        spent += pair[name]["clock"]
    times = np.array(pairs)
    ratio = np.log(times[:, 0] / times[:, 1])
    from fractalcontact.core.intervals import t_quantile

    seconds, ours = np.median(times, axis=0)
    row |= {"seconds": float(seconds), "ours": float(ours), "pairs": len(pairs)}
    row["times"] = float(np.exp(ratio.mean()))
    if len(ratio) > 1:
        half = t_quantile(len(ratio) - 1) * ratio.std(ddof=1) / np.sqrt(len(ratio))
        row["low"], row["high"] = (float(np.exp(ratio.mean() + s * half)) for s in (-1, 1))
    return row


def _time(found, threads):
    return found["processor" if threads == 1 else "clock"] if "failed" not in found else np.nan


def _judged(found, load, options):
    """Error of an answer, its counters, and why its time is not to be read, if so."""
    if "failed" in found:
        return {"note": found["failed"]}
    error = max(
        abs(found["closure"] / load["closure"] - 1), abs(found["force"] / load["force"] - 1)
    )
    return {
        "error": error,
        "note": "" if error <= options.error else "disqualified: its error is off",
        "applications": found["applications"],
        "path": found["path"],
        "peak GB": found["peak"],
    }


def _load(size, percent, options):
    """Surface, force and exact closure of a cell: made once for all threads and solvers."""
    name = options.output / f"surface_{size}_{options.seed}.npy"
    kept = options.output / f"load_{size}_{options.seed}_{percent:g}.json"
    if not kept.exists():
        what = {"make": str(name), "size": size, "percent": percent, "seed": options.seed}
        found = _run({**what, "judge": size <= MAPPED})
        kept.write_text(json.dumps({"heights": str(name), **found}))
    return json.loads(kept.read_text())


class _Worker:
    """A process that solves one cell with one solver each time it is asked to."""

    def __init__(self, name, load, threads, limit):
        self.limit, self.failed = limit, None
        self.process = _process({"solver": name, **load}, threads)

    def solve(self, *, warm=False):
        """What the process reports: seconds, counters and, of the first, the closure."""
        if self.failed is not None:
            return {"failed": self.failed}
        self.process.stdin.write("judge\n" if warm else "solve\n")
        self.process.stdin.flush()
        # The first loads the surface and is judged as well.
        wait = self.limit + (JUDGING if warm else 0)
        ready, _, _ = select.select([self.process.stdout], [], [], wait)
        line = self.process.stdout.readline() if ready else ""
        late = f"{TOO_LONG} {self.limit:g} s"
        found = json.loads(line) if line else {"failed": "its process ended" if ready else late}
        if "failed" in found or found["clock"] > self.limit:
            self.failed = found.get("failed", late)
            self.process.kill()
            return {"failed": self.failed}
        return found

    def end(self):
        """Let the process end."""
        self.process.stdin.close()
        self.process.wait()


def _process(what, threads):
    environment = os.environ | {"OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, __file__, "--work", json.dumps(what)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    return subprocess.Popen(command, env=environment, text=True, **pipes)


def _run(what):
    """The one line that a process of its own prints."""
    output, _ = _process(what, 1).communicate()
    return json.loads(output)


# What is measured: in a process of its own.


def _work(what):
    if "make" in what:
        sys.stdout.write(json.dumps(_made(what)))
        return
    solve = _ours(what) if what["solver"] in OURS else _peer(what)
    for line in sys.stdin:
        sys.stdout.write(json.dumps(_timed(solve, what, line.strip() == "judge")) + "\n")
        sys.stdout.flush()


def _heights(what):
    heights = np.load(what["heights"], mmap_mode="r", allow_pickle=False)
    return heights if heights.dtype == np.float32 else np.array(heights)


def _timed(solve, what, judge):
    """One solve: its seconds and counters; where it is to be judged, closure and force too."""
    import resource
    import time

    clock, processor = time.perf_counter(), time.process_time()
    try:
        pressure, space, applications, path = solve()
    except Exception as error:  # a public code raises whatever it raises: the row says it
        return {"failed": str(error) or type(error).__name__}
    clock, processor = time.perf_counter() - clock, time.process_time() - processor
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    found = {"clock": clock, "processor": processor, "applications": applications, "path": path}
    found["peak"] = peak * (1 if sys.platform == "darwin" else 1024) / 1e9
    if judge:
        found["force"] = float(pressure.sum(dtype=float)) * space.cell_area
        found["closure"] = what["closure"]
        if what["judged"]:
            found["closure"] = _closure(pressure, space, _heights(what))
    return found


def _closure(pressure, space, heights):
    """The closure that a pressure belongs to: its mean over the load, mm."""
    reached = space.displacement(np.asarray(pressure, float)) + (heights.max() - heights)
    return float((pressure * reached).sum() / pressure.sum(dtype=float))


def _space(heights):
    from fractalcontact import HalfSpace

    ny, nx = heights.shape
    return HalfSpace((ny, nx), (1 / ny, 1 / nx), 1.0)


def _ours(what):
    """Ours: ``with set-up`` keeps nothing of a grid from one solve to the next."""
    from solvers import forget

    from fractalcontact import solve_contact
    from fractalcontact.contact.state import CandidateState
    from fractalcontact.elastic.block_influence import forget_matrices

    heights = _heights(what)
    kept = _space(heights)

    def solve():
        space = kept
        if what["solver"] == "with set-up":
            space = _space(heights)
            forget_matrices()
        forget(space)
        state = solve_contact(heights, space, force=what["force"], rtol=RTOL)
        path = f"convolution, residual {state.residual:.1e}"
        if isinstance(state, CandidateState):
            path = f"{state.candidates} candidates, residual {state.residual:.1e}"
        return state.pressure, state.space, state.iterations, path

    return solve


def _peer(what):
    """A mode of a public code, set up and solved anew each time."""
    from fractalcontact.methods.peers import Load
    from fractalcontact.methods.registry import installed_peers

    heights = _heights(what)
    peers = installed_peers()

    def solve():
        if what["solver"] not in peers:
            raise RuntimeError(f"{what['solver']} is not installed")
        code = peers[what["solver"]].set_up(heights, _space(heights))
        pressure = code.solve(Load(force=what["force"]), RTOL)
        return pressure, code.space, code.applications, code.path

    return solve


def _made(what):
    """Make a surface if there is none, and find the force at which a fraction of it touches."""
    from fractalcontact import solve_contact
    from fractalcontact.surface.synthesis import self_affine

    path, size = Path(what["make"]), what["size"]
    if not path.exists():
        if size > LARGEST_IN_DOUBLE:
            heights = _in_single_precision(size, what["seed"])
        else:
            heights = self_affine((size, size), 1 / size, HURST, rms=RMS, seed=what["seed"])
        np.save(path, heights if size <= MAPPED else heights.astype(np.float32, copy=False))
    heights = _heights({"heights": path})
    space, wanted = _space(heights), what["percent"] / 100
    force, state, low, high = RMS * wanted, None, 0.0, np.inf
    for _ in range(40):
        state = solve_contact(heights, space, force=force, start=state, rtol=1e-4)
        ratio = state.area / wanted
        if abs(ratio - 1) <= MET:
            break
        low, high = (force, high) if ratio < 1 else (low, force)
        trial = force / ratio
        force = trial if low < trial < high else (low + min(high, 4 * low)) / 2
    found = {"force": force, "closure": state.closure, "judged": what["judge"]}
    if what["judge"]:
        exact = solve_contact(heights, space, force=force, start=state, rtol=1e-8)
        found["closure"] = _closure(exact.pressure, space, np.asarray(heights, float))
    return found


def _in_single_precision(size, seed):
    """The surface of ``self_affine``, but for rounding: its noise is filtered row by row."""
    import scipy.fft

    from fractalcontact.surface.synthesis import EMBEDDING, levelled

    side = EMBEDDING * size
    generator = np.random.Generator(np.random.PCG64(seed))
    noise = np.empty((side, side), np.float32)
    for row in noise:
        row[:] = generator.standard_normal(side)
    spectrum = scipy.fft.rfft2(noise, overwrite_x=True)
    del noise
    along_x = scipy.fft.rfftfreq(side)
    for row, along_y in zip(spectrum, scipy.fft.fftfreq(side), strict=True):
        waves = np.hypot(along_x, along_y)
        waves[waves == 0] = np.inf
        row *= (waves ** -(1 + HURST)).astype(np.float32)
    patch = scipy.fft.irfft2(spectrum, (side, side), overwrite_x=True)[:size, :size].copy()
    del spectrum
    return levelled(patch, RMS).astype(np.float32)


# What is written.


def growth(rows, column):
    """Exponent of the power law of a column over the nodes, of each solver, fraction and threads.

    Parameters
    ----------
    rows : list of dict
        Of the table.
    column : str
        ``"seconds"`` or ``"peak GB"``.

    Yields
    ------
    solver, contact, threads : str
    exponent, error : float
        The error is the standard error of a least-squares fit, NaN of two sizes.
    """
    groups: dict[tuple, list] = {}
    for row in rows:
        if row.get(column) not in (None, "") and not row.get("note"):
            key = row["solver"], str(row["contact"]), str(row["threads"])
            groups.setdefault(key, []).append((2 * np.log(int(row["size"])), float(row[column])))
    for key, points in groups.items():
        x, y = np.array(points).T
        if len(set(x)) < 2:
            continue
        y = np.log(y)
        slope, offset = np.polyfit(x, y, 1)
        rest, spread = y - slope * x - offset, ((x - x.mean()) ** 2).sum()
        error = np.sqrt((rest**2).sum() / (len(x) - 2) / spread) if len(x) > 2 else np.nan
        yield *key, slope, error


def _read(folder):
    path = folder / "beside_peers.csv"
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _write(folder, rows):
    """Both tables; returns that for reading."""
    with (folder / "beside_peers.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        lines.append("| " + " | ".join(_text(row.get(column)) for column in COLUMNS) + " |")
    lines += ["", *(f"- {line}" for line in _summary(rows)), ""]
    for column in ("seconds", "peak GB"):
        for solver, contact, threads, exponent, error in growth(rows, column):
            law = f"{column} grow as nodes^{exponent:.2f}"
            law += f" +- {error:.2f}" if np.isfinite(error) else ""
            lines.append(f"- {solver}, {contact} %, {threads} threads: {law}")
    text = "\n".join(lines) + "\n"
    (folder / "beside_peers.md").write_text(text)
    return text


def _summary(rows):
    """How many times faster than the fastest mode of the peer, in the median of light and dense."""
    best: dict[tuple, float] = {}
    for row in rows:
        if row.get("times") not in (None, "") and not row.get("note"):
            key = int(row["size"]), float(row["contact"]), int(row["threads"])
            best[key] = min(best.get(key, np.inf), float(row["times"]))
    for threads in sorted({key[2] for key in best}):
        here = {key: times for key, times in best.items() if key[2] == threads}
        yield f"{threads} threads: least {min(here.values()):.2g} times, in {len(here)} cells"
        for name, of in (("below 0.5 %", lambda f: f < 0.5), ("above 2 %", lambda f: f > 2)):
            some = [times for key, times in here.items() if of(key[1])]
            if some:
                yield f"{threads} threads, {name}: {np.median(some):.2g} times in the median"


def _text(value):
    try:
        return f"{float(value):.3g}" if "." in str(value) or "e" in str(value) else str(value or "")
    except (TypeError, ValueError):
        return str(value or "")


if __name__ == "__main__":
    main()
