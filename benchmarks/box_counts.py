"""Box counts timed: every size of box, on domains of growing size, by `python box_counts.py`."""

import argparse
import sys
import time

import numpy as np

from fractalcontact.domain.box_counts import box_count, box_sizes, mean_count, whole_sizes
from fractalcontact.surface.synthesis import self_affine

#: Fraction of the window in contact.
FRACTION = 0.1


def seconds(count, domain, sizes, runs):
    """Fastest of some runs."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        count(domain, sizes)
        times.append(time.perf_counter() - start)
    return min(times)


def main(arguments):
    """Time the counts and write a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=[512, 1024, 2048, 4096])
    parser.add_argument("--runs", type=int, default=1)
    options = parser.parse_args(arguments)
    small = np.ones((8, 8), dtype=bool)
    box_count(small, [2.0])  # compiled
    mean_count(small, [2])
    line = "{:>6} {:>9} {:>10} {:>9} {:>10} {:>9}\n"
    write = sys.stdout.write
    write(line.format("cells", "fewest s", "growth", "mean s", "growth", "box sizes"))
    before = None
    for n in options.sizes:
        heights = self_affine((n, n), 1.0 / n, 0.8, rms=1.0, seed=1)
        domain = heights > np.quantile(heights, 1 - FRACTION)
        took = np.array(
            [
                seconds(count, domain, sizes, options.runs)
                for count, sizes in ((box_count, box_sizes(n)), (mean_count, whole_sizes(n / 2)))
            ]
        )
        sizes = np.array([box_sizes(n).size, whole_sizes(n / 2).size])
        # Time per cell and size of box, over that of the grid before: 1 where it is linear.
        each = took / sizes / n**2
        growth = ["", ""] if before is None else [f"{g:.2f}" for g in each / before]
        columns = [f"{took[0]:.3f}", growth[0], f"{took[1]:.3f}", growth[1]]
        write(line.format(n, *columns, ", ".join(map(str, sizes))))
        before = each


if __name__ == "__main__":
    main(sys.argv[1:])
