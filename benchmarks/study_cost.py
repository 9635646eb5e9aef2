"""Where the time of a study went: solves, other work, and what is neither.

    python benchmarks/study_cost.py config/paper.yaml --cores 2

It reads the last line of the log of each job: its work, solves and processor time. The column
"solves" is the processor time in multiples of one cold solve of 1024 x 1024 nodes, timed beside the
study, so that tables of different machines can be compared.
"""

import argparse
import os
import re
import time
from collections import defaultdict

import numpy as np

from fractalcontact.commands.verify import results_of
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

WORKED = re.compile(
    r"worked ([\d.]+) s, of which ([\d.]+) s on (\d+) contact problems; "
    r"processor time ([\d.]+) s"
)


#: Test problem of the cold solve: nodes per side, Hurst exponent, side over roll-off, fraction of
#: the nodes in contact, runs of which the median counts.
SIDE, HURST, ROLL_OFFS, FRACTION, RUNS = 1024, 0.8, 4, 0.02, 5


def seconds_of_cold_solve(side=SIDE):
    """Processor time of a cold solve on one thread, set-up of the operator included."""
    height = self_affine((side, side), 1 / side, HURST, rms=0.01, seed=1, roll_off=1 / ROLL_OFFS)
    low, high, state = 0.0, float(np.ptp(height)), None
    for _ in range(20):
        closure = (low + high) / 2
        state = solve_contact(height, _space(side), closure=closure, start=state, rtol=1e-3)
        fraction = state.in_contact.mean()
        if abs(fraction / FRACTION - 1) < 0.05:
            break
        low, high = (closure, high) if fraction < FRACTION else (low, closure)
    seconds = []
    for _ in range(RUNS):
        begin = time.process_time()
        solve_contact(height, _space(side), closure=closure)
        seconds.append(time.process_time() - begin)
    return float(np.median(seconds))


def _space(side):
    return HalfSpace((side, side), (1 / side, 1 / side), 1.0)


def jobs_of(results):
    """Every job: stage, seconds that it worked, solved and computed, problems and end."""
    for log in sorted((results / "logs").rglob("*.log")):
        found = WORKED.findall(log.read_text(encoding="utf-8"))
        if not found:
            raise SystemExit(f"{log}: says nothing of its work; run the study again")
        worked, solving, problems, processor = found[-1]
        stage = log.relative_to(results / "logs").parts[0].removesuffix(".log")
        yield stage, float(worked), float(solving), float(processor), int(problems), log.stat()


def stages_of(results):
    """Sums by stage: jobs, seconds worked, solving, processor time, problems; and wall time."""
    jobs = list(jobs_of(results))
    sums = defaultdict(lambda: [0, 0.0, 0.0, 0.0, 0])
    for stage, *numbers, _ in jobs:
        total = sums[stage]
        sums[stage] = [total[0] + 1, *(a + b for a, b in zip(total[1:], numbers, strict=True))]
    ends = [job[-1].st_mtime for job in jobs]
    wall = max(ends) - min(end - job[1] for end, job in zip(ends, jobs, strict=True))
    return dict(sums), wall


def main():
    """Print the cost of the results given on the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", help="a study that was run from scratch, or its results")
    parser.add_argument("--cores", type=int, default=2)
    options = parser.parse_args()
    sums, wall = stages_of(results_of(options.study))
    os.environ["OMP_NUM_THREADS"] = "1"  # of the solve alone: the study is done
    solve = seconds_of_cold_solve()
    heads = ("work", "solving", "processor", "solves", "problems")
    print(f"{'stage':24s}{'jobs':>6s}" + "".join(f"{head:>10s}" for head in heads))
    rows = sorted(sums.items(), key=lambda item: -item[1][1])
    total = [sum(numbers[i] for _, numbers in rows) for i in range(5)]
    for stage, (n, *times, problems) in [*rows, ("all", total)]:
        columns = "".join(f"{seconds:10.1f}" for seconds in (*times, times[-1] / solve))
        print(f"{stage:24s}{n:6d}{columns}{problems:10d}")
    available = wall * options.cores
    print(
        f"wall {wall:.0f} s x {options.cores} cores = {available:.0f} s; neither solves, fits nor "
        f"figures: {1 - total[1] / available:.0%}"
    )
    print(
        f"a cold solve of {SIDE} x {SIDE} nodes, H {HURST:g}, roll-off 1/{ROLL_OFFS} of the side, "
        f"{FRACTION:.0%} in contact, one thread: {solve:.2f} s; wall {wall / solve:.0f} of it"
    )


if __name__ == "__main__":
    main()
