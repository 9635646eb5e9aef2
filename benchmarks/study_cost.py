"""Where the time of a study went: solves, other work, and what is neither.

    python benchmarks/study_cost.py config/paper.yaml --cores 2

It reads the last line of the log of each job: its work, solves and processor time.
"""

import argparse
import re
from collections import defaultdict

from fractalcontact.commands.verify import results_of

WORKED = re.compile(
    r"worked ([\d.]+) s, of which ([\d.]+) s on (\d+) contact problems; "
    r"processor time ([\d.]+) s"
)


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
    print(
        f"{'stage':20s}{'jobs':>6s}{'work':>10s}{'solving':>10s}{'processor':>10s}{'problems':>10s}"
    )
    rows = sorted(sums.items(), key=lambda item: -item[1][1])
    total = [sum(numbers[i] for _, numbers in rows) for i in range(5)]
    for stage, (n, *times, problems) in [*rows, ("all", total)]:
        columns = "".join(f"{seconds:10.1f}" for seconds in times)
        print(f"{stage:20s}{n:6d}{columns}{problems:10d}")
    available = wall * options.cores
    print(
        f"wall {wall:.0f} s x {options.cores} cores = {available:.0f} s; neither solves, fits nor "
        f"figures: {1 - total[1] / available:.0%}"
    )


if __name__ == "__main__":
    main()
