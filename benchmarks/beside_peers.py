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
a peer that says that it failed, or takes longer than ``--limit``. Where ours does, the peer is
timed alone, without a ratio. ``path`` are the counters that prove which way the last call went.
Peak memory is that of the whole process, which holds the surface and, of the peer, what it is given
and gives.

Tables beside_peers.csv and .md go to ``--output``, after each cell; cells that are there are not
measured again, so that a run that was ended goes on. The last lines are how time and memory grow
with the nodes at each fraction: exponents of power laws, with standard errors.
"""

import argparse
import json
import sys
from itertools import product
from pathlib import Path

import numpy as np
from peers_tables import read, write
from peers_worker import MAPPED, OURS, TOO_LONG, Worker, run_once

PEERS = ("ASPHER active set", "ASPHER fft")
BEYOND = "not tried: too long with fewer nodes or less contact"


def main():
    """Measure what the command line asks for, and write the tables."""
    options = _options()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = read(options.output)
    known = {(row["size"], row["contact"], row["threads"]) for row in rows}
    wanted = list(product(options.sizes, options.fractions, options.threads))
    for size, percent, threads in wanted:
        if (str(size), f"{percent:g}", str(threads)) in known:
            continue
        sys.stderr.write(f"{size}, {percent:g} % in contact, {threads} threads ...\n")
        rows += _cell(size, percent, threads, options, rows)
        write(options.output, rows)
    sys.stdout.write(write(options.output, rows))


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
    return parser.parse_args()


def _cell(size, percent, threads, options, before):
    """Rows of one cell: ours with and without set-up, and every mode of the peer.

    A solver that took too long ``before``, with no more nodes or contact, is not tried again.
    """
    load = _load(size, percent, options)
    row = {"size": size, "contact": f"{percent:g}", "threads": threads}
    wanted = [*OURS, *(p for p in options.peers if "ASPHER" not in p or size & (size - 1) == 0)]
    names = [name for name in wanted if not _beyond(name, size, percent, threads, before)]
    rows = [row | {"solver": name, "note": BEYOND} for name in wanted if name not in names]
    workers = {name: Worker(name, load, threads, options.limit) for name in names}
    answers = {name: worker.solve(warm=True) for name, worker in workers.items()}
    for name in [name for name in names if name not in OURS]:
        rows.append(row | _peer(name, workers, answers, load, threads, options))
    for name in [name for name in names if name in OURS]:
        rows.append(row | _ours(name, workers[name], answers[name], load, threads, options))
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


def _peer(name, workers, answers, load, threads, options):
    """The row of a mode of the peer, in turn with ours with its set-up.

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
    from fractalcontact.core.intervals import t_quantile

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
        found = run_once({**what, "judge": size <= MAPPED})
        kept.write_text(json.dumps({"heights": str(name), **found}))
    return json.loads(kept.read_text())


if __name__ == "__main__":
    main()
