"""Where the time of a study went: solves, other work, and what is neither.

    python benchmarks/study_cost.py config/paper.yaml --cores 2

It reads what each job wrote beside its results: its log's last line (work, solves and processor
time) and its benchmark (from start to end, imports included; what else stands there is of the
process that waits for a fork of the warm interpreter).
"""

import argparse
import csv
import re
from collections import defaultdict

from fractalcontact.commands.verify import results_of

WORKED = re.compile(
    r"worked ([\d.]+) s, of which ([\d.]+) s on (\d+) contact problems; "
    r"processor time ([\d.]+) s"
)


def jobs_of(results):
    """Every job: stage, seconds, those it worked, solved and computed, problems and end."""
    for path in sorted((results / "benchmarks").rglob("*.tsv")):
        log = (results / "logs" / path.relative_to(results / "benchmarks")).with_suffix(".log")
        found = WORKED.findall(log.read_text(encoding="utf-8"))
        if not found:
            raise SystemExit(f"{log}: says nothing of its work; run the study again")
        with open(path, encoding="utf-8") as file:
            seconds = float(next(csv.DictReader(file, delimiter="\t"))["s"])
        worked, solving, problems, processor = found[-1]
        stage = path.relative_to(results / "benchmarks").parts[0].removesuffix(".tsv")
        numbers = float(worked), float(solving), float(processor), int(problems)
        yield stage, seconds, *numbers, log.stat().st_mtime


def stages_of(results):
    """Sums by stage: jobs, seconds, worked, solving, processor time, problems; and wall time."""
    jobs = list(jobs_of(results))
    sums = defaultdict(lambda: [0, 0.0, 0.0, 0.0, 0.0, 0])
    for stage, *numbers, _ in jobs:
        total = sums[stage]
        sums[stage] = [total[0] + 1, *(a + b for a, b in zip(total[1:], numbers, strict=True))]
    wall = max(job[-1] for job in jobs) - min(job[-1] - job[1] for job in jobs)
    return dict(sums), wall


def main():
    """Print the cost of the results given on the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", help="a study that was run from scratch, or its results")
    parser.add_argument("--cores", type=int, default=2)
    options = parser.parse_args()
    sums, wall = stages_of(results_of(options.study))
    print(
        f"{'stage':20s}{'jobs':>6s}{'seconds':>10s}{'work':>10s}{'solving':>10s}{'processor':>10s}"
        f"{'problems':>10s}"
    )
    rows = sorted(sums.items(), key=lambda item: -item[1][1])
    total = [sum(numbers[i] for _, numbers in rows) for i in range(6)]
    for stage, (n, *times, problems) in [*rows, ("all", total)]:
        columns = "".join(f"{seconds:10.1f}" for seconds in times)
        print(f"{stage:20s}{n:6d}{columns}{problems:10d}")
    available = wall * options.cores
    overhead = 1 - total[2] / available
    print(
        f"wall {wall:.0f} s x {options.cores} cores = {available:.0f} s; neither solves, fits nor "
        f"figures: {overhead:.0%} (starting jobs {(total[1] - total[2]) / available:.0%}, "
        f"no job running {1 - total[1] / available:.0%})"
    )


if __name__ == "__main__":
    main()
