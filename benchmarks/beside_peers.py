"""The contact solver beside other methods and other codes, in pairs timed in turn.

    python benchmarks/beside_peers.py                  512 x 512, beside all installed codes
    python benchmarks/beside_peers.py --quick          256 x 256: two minutes
    python benchmarks/beside_peers.py --loads 16       sweeps of 16 loads, each from the one before
    python benchmarks/beside_peers.py --peers dense gauss-seidel --sizes 64
    python benchmarks/beside_peers.py --alone --sizes 2048 4096 8192 --fractions 0.05 0.5

Each cell of the table is one self-affine surface loaded until a fraction of it touches, solved by
ours under a force and by every peer under the load that it declares first, each in a process of its
own with that many threads. Peers are public codes (``make bench PEERS=1`` installs them; ASPHER is
built, see its module) and the package's own methods, by name. Ours is timed in turn with the peer,
twice: with what belongs to the grid (kernel, transforms, operator between blocks) made anew in each
solve, as it is for the peer, and with that kept. Compiled kernels are loaded before, for both. One
thread is compared by processor time, several by the clock. A ratio of times has its 95 % interval
over the pairs, if more than one is worth waiting for.

Ours begins at a tolerance of 1e-6, a peer at a looser one than it is likely to need, and each goes
to tighter ones until its answer is close enough: the closure that its pressure has under a
convolution in double precision, against one of ours to 1e-8, and its force (in windows of more than
4096 nodes along a side the force alone). Beyond ``--error`` the row is disqualified; so is a peer
that says that it failed, or takes longer than ``--limit``. Where ours does, the peer is timed
alone, without a ratio. ``path`` are the counters that prove which way the last call went;
``applications`` are those a load, of a sweep after the first. Peak memory is that of the whole
process, which holds the surface and, of the peer, what it is given and gives.

Tables beside_peers.csv and .md go to ``--output``, after each cell; cells that are there are not
measured again, so that a run that was ended goes on. The last lines are how time and memory grow
with the nodes at each fraction: exponents of power laws, with standard errors.
"""

import argparse
import json
import sys
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
from peers_tables import read, write
from peers_worker import MAPPED, OURS, TOO_LONG, Worker, run_once

from contactlab.methods.registry import METHODS, installed_peers
from fractalcontact import HalfSpace
from fractalcontact.core.intervals import t_quantile

BEYOND = "not tried: too long with fewer nodes or less contact"
#: Tolerances are tried in these steps, as far as the tightest.
RTOL, STEP, TIGHTEST = 1e-6, 10**0.5, 1e-10


class Cell(NamedTuple):
    """Problem of one cell of the table; ``contact`` is the part that touches, %."""

    size: int
    contact: float
    threads: int = 1
    hurst: float = 0.8
    loads: int = 1

    def row(self):
        """Columns that name the cell."""
        return self._asdict() | {"contact": f"{self.contact:g}"}


def main():
    """Measure what the command line asks for, and write the tables."""
    options = _options()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = read(options.output)
    known = {_cell_of(row) for row in rows}
    every = options.sizes, options.fractions, options.threads, options.hurst, [options.loads]
    for cell in (Cell(*one) for one in product(*every)):
        if cell not in known:
            sys.stderr.write(f"{', '.join(f'{k} {v}' for k, v in cell.row().items())} ...\n")
            rows += _rows(cell, options, rows)
            write(options.output, rows)
    sys.stdout.write(write(options.output, rows))


def _options():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--sizes", type=int, nargs="+", default=[512], help="nodes per side")
    add("--fractions", type=float, nargs="+", default=[0.5, 2, 8, 20], help="in contact, %%")
    add("--hurst", type=float, nargs="+", default=[0.8])
    add("--loads", type=int, default=1, help="of a sweep: those that start from a load alone")
    add("--threads", type=int, nargs="+", default=[1])
    add("--pairs", type=int, default=5, help="most of each cell")
    add("--patience", type=float, default=60, help="no further pair after this many seconds")
    add("--limit", type=float, default=600, help="of one solve or sweep, seconds")
    add("--error", type=float, default=1e-5, help="of closure or force, relative, at most")
    add("--peers", nargs="+", default=[*installed_peers()], choices=[*METHODS, *installed_peers()])
    add("--alone", dest="peers", action="store_const", const=[], help="ours only")
    add("--quick", action="store_true", help="256 x 256, two fractions, three pairs")
    add("--seed", type=int, default=1)
    add("--output", type=Path, default=Path("results/benchmarks"))
    options = parser.parse_args()
    if options.quick:
        options.sizes, options.fractions, options.pairs = [256], [2, 8], 3
    return options


def _cell_of(row):
    """Cell that a row of the table is of."""
    types = int, float, int, float, int
    return Cell(*(kind(row[name]) for kind, name in zip(types, Cell._fields, strict=True)))


def _rows(cell, options, before):
    """Rows of one cell: ours with and without set-up, and every peer that takes it.

    A solver that took too long ``before``, with no more nodes or contact, is not tried again.
    """
    load, space = _load(cell, options), HalfSpace((cell.size, cell.size), 1 / cell.size, 1.0)
    peers = {name: {**METHODS, **installed_peers()}[name] for name in options.peers}
    wanted = [
        *OURS,
        *(n for n, peer in peers.items() if peer.takes(space) and (cell.loads == 1 or peer.warm)),
    ]
    names = [name for name in wanted if not _beyond(name, cell, before)]
    rows = [cell.row() | {"solver": name, "note": BEYOND} for name in wanted if name not in names]
    workers = {name: Worker(name, load, cell.threads, options.limit) for name in names}
    loosest = {name: 10 ** (peer.likely + 1) for name, peer in peers.items()}
    answers = {
        name: _first(worker, loosest.get(name, RTOL), load, options.error)
        for name, worker in workers.items()
    }
    for name in [name for name in names if name not in OURS]:
        rows.append(cell.row() | _peer(name, workers, answers, load, cell.threads, options))
    for name in [name for name in names if name in OURS]:
        own = _ours(name, workers[name], answers[name], load, cell.threads, options)
        rows.append(cell.row() | own)
    for worker in workers.values():
        worker.end()
    return rows


def _first(worker, tolerance, load, most):
    """First answer that is close enough, at the loosest tolerance of those tried."""
    while True:
        answer = worker.judge(tolerance)
        if "failed" in answer or tolerance < 2 * TIGHTEST or _error(answer, load) <= most:
            return answer | {"tolerance": tolerance}
        tolerance /= STEP


def _beyond(name, cell, rows):
    """Whether a solver took too long in a cell of no more nodes and no more contact."""
    for row in rows:
        if row["solver"] == name and str(row.get("note", "")).startswith((TOO_LONG, BEYOND)):
            of = _cell_of(row)
            more = of.size <= cell.size and of.contact <= cell.contact
            if more and of.threads >= cell.threads and of.loads <= cell.loads:
                return True
    return False


def _peer(name, workers, answers, load, threads, options):
    """The row of a peer, in turn with ours with its set-up.

    Where ours was not tried, or failed in its first solve, the peer is timed alone: no ratio.
    """
    row = {"solver": name} | _judged(answers[name], load, options)
    if row["note"]:
        return row
    compared = [name, OURS[0]] if "failed" not in answers.get(OURS[0], {"failed": ""}) else [name]
    # One pair is enough, without an interval, where the first solve tries the patience.
    pairs, spent = [], answers[name]["clock"]
    least = 1 if spent > options.patience else 2
    while len(pairs) < least or (len(pairs) < options.pairs and spent < options.patience):
        order = compared[::-1] if len(pairs) % 2 else compared
        pair = {who: workers[who].solve() for who in order}
        if note := _failed_later(pair.items()):
            return row | {"note": note}
        pairs.append([_time(pair[who], threads) for who in compared])
        spent += pair[name]["clock"]
    times = np.array(pairs)
    row |= {"seconds": float(np.median(times[:, 0])), "pairs": len(pairs)}
    if len(compared) > 1:
        row |= {"ours": float(np.median(times[:, 1])), **_ratio(times)}
    return row


def _ratio(times):
    """Times of the peer over ours, (pairs, 2), and the 95 % interval, if there is more than one."""
    ratio = np.log(times[:, 0] / times[:, 1])
    found = {"times": float(np.exp(ratio.mean()))}
    if len(ratio) > 1:
        half = t_quantile(len(ratio) - 1) * ratio.std(ddof=1) / np.sqrt(len(ratio))
        for name, sign in (("low", -1), ("high", 1)):
            found[name] = float(np.exp(ratio.mean() + sign * half))
    return found


def _ours(name, worker, answer, load, threads, options):
    """The row of ours, timed alone."""
    row = {"solver": name} | _judged(answer, load, options)
    if "failed" in answer:
        return row
    runs = [worker.solve() for _ in range(options.pairs)]
    if note := _failed_later((name, run) for run in runs):
        return row | {"note": note}
    seconds = float(np.median([_time(run, threads) for run in runs]))
    return row | {"seconds": seconds, "pairs": len(runs)}


def _failed_later(runs):
    """Who failed first of (name, run) pairs, and how; nothing if none did."""
    for name, found in runs:
        if "failed" in found:
            return f"{name} failed in a later run: {found['failed']}"
    return ""


def _time(found, threads):
    """Of the processor where one thread is compared, else of the clock."""
    return found["processor" if threads == 1 else "clock"]


def _error(found, load):
    """Relative error of an answer: that of its closure or force, if more."""
    exact = load["steps"][-1]
    return max(abs(found[name] / exact[name] - 1) for name in ("closure", "force"))


def _judged(found, load, options):
    """Error of an answer, its counters, and why its time is not to be read, if so."""
    if "failed" in found:
        return {"note": found["failed"]}
    error = _error(found, load)
    return {
        "error": error,
        "note": "" if error <= options.error else "disqualified: its error is off",
        "tolerance": found["tolerance"],
        "applications": found["applications"],
        "path": found["path"],
        "peak GB": found["peak"],
    }


def _load(cell, options):
    """Surface and exact loads of a cell: made once for all threads and solvers."""
    of = f"{cell.size}_{cell.hurst:g}_{options.seed}"
    name = options.output / f"surface_{of}.npy"
    kept = options.output / f"load_{of}_{cell.contact:g}_{cell.loads}.json"
    if not kept.exists():
        what = {"make": str(name), **cell._asdict(), "seed": options.seed}
        found = run_once({**what, "judge": cell.size <= MAPPED})
        kept.write_text(json.dumps({"heights": str(name), **found}), encoding="utf-8")
    return json.loads(kept.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
