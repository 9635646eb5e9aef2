"""Contacts that yield: solved, judged and timed beside elastic ones of the same scenes.

    python benchmarks/capped.py                     5,000 problems; an hour of one core
    python benchmarks/capped.py --problems 200      minutes

Problems are drawn: faces, plateaus and terraces of 24 to 1024 nodes per side, most of 64 to 256;
hardness of 1e-4 to 1 of the modulus; forces of 1e-4 to 0.99 of what the window carries. Every state
is judged by a convolution of its own (`roughcontact.contact.violation`). The
script prints the problems given up, the wrong states, and the table "Where nodes yield" of
packages/roughcontact/docs/solver_speed.md. Seconds are of the processor, of one thread where
OMP_NUM_THREADS is 1.
"""

import argparse
import sys
import time
from collections import defaultdict

import numpy as np

from fractalcontact import HalfSpace, NotConverged, self_affine, solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.contact.violation import violation

MODULUS, SPACING, RTOL = 2e4, 0.05, 1e-6
#: Shares of the window that yield, below which a row of the table counts.
SHARES = (0.001, 0.01, 0.1, 0.5, 1.0)
#: Nodes per side up to which problems count in a column of it.
SIDES = (32, 128, 256, 512, 1024)


def drawn(draw: int) -> tuple[np.ndarray, HalfSpace, float, float]:
    """A topography, its half-space, a hardness and the share of the window's capacity as force."""
    generator = np.random.default_rng([390, draw])
    small, large = draw % 10 == 0, generator.random() > 0.93
    side = int(generator.integers(64, 257))
    if small or large:
        sides, weights = ((24, 32), (0.5, 0.5)) if small else ((512, 768, 1024), (0.6, 0.2, 0.2))
        side = int(generator.choice(sides, p=weights))
    rms = 0.3 * 10 ** generator.uniform(-1.5, 0)
    hurst, roll_off = generator.uniform(0.5, 0.9), min(2.5, side * SPACING / 2)
    height = self_affine((side, side), SPACING, hurst, rms=rms, seed=draw, roll_off=roll_off)
    if draw % 7 == 5:
        height = np.minimum(height, np.quantile(height, 0.9))
    elif draw % 7 == 6:
        height = np.round(height / (0.02 * rms)) * 0.02 * rms
    hardness = MODULUS * 10 ** generator.uniform(-4, 0)
    share = min(0.99, 10 ** generator.uniform(-4, 0))
    return height, HalfSpace(height.shape, SPACING, MODULUS), hardness, share


def main() -> None:
    """Solve what the command line asks for and print what came of it."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--problems", type=int, default=5000)
    parser.add_argument("--first", type=int, default=0)
    options = parser.parse_args()
    for draw in range(60):  # kernels are compiled, or read, before anything is timed
        height, space, hardness, share = drawn(draw)
        for limit in (None, hardness):
            solve_contact(height, space, closure=0.1 * np.ptp(height), hardness=limit)
    given_up, wrong, worst = [], [], 0.0
    ratios, seconds = defaultdict(list), defaultdict(list)
    for draw in range(options.first, options.first + options.problems):
        height, space, hardness, share = drawn(draw)
        force = share * hardness * space.cell_area * height.size
        begin = time.process_time()
        try:
            state = solve_contact(height, space, force=force, hardness=hardness, rtol=RTOL)
        except NotConverged:
            given_up.append(draw)
            continue
        middle = time.process_time()
        solve_contact(height, space, force=force, rtol=RTOL)
        capped, elastic = middle - begin, time.process_time() - middle
        found = judged(state, height, force)
        worst = max(worst, found)
        if not found <= 1.02 * RTOL:
            wrong.append(draw)
        key = next(s for s in SIDES if max(space.shape) <= s), next(s for s in SHARES if share <= s)
        ratios[key].append(capped / elastic)
        seconds[key].append(capped)
    sys.stdout.write(
        f"{options.problems} problems: given up {given_up or 'none'}, wrong {wrong or 'none'}; "
        f"largest violation {worst:.3g}\n\n{table(ratios, seconds)}"
    )


def judged(state: ContactState, height: np.ndarray, force: float) -> float:
    """Largest violation of a condition, of the closure; or by how much the force is missed."""
    found, rounding = violation(state, height)
    return max(found - rounding, abs(state.force / force - 1))


def table(ratios: dict, seconds: dict) -> str:
    """Median seconds of a capped solve and, in brackets, times those of the elastic one."""
    lines = ["| nodes per side, up to | " + " | ".join(f"{share:.1%}" for share in SHARES) + " |"]
    lines.append("|---|" + "---:|" * len(SHARES))
    for side in SIDES:
        cells = [
            f"{np.median(seconds[side, share]):.2g} s (x {np.median(ratios[side, share]):.2g})"
            if seconds[side, share]
            else ""
            for share in SHARES
        ]
        lines.append(f"| {side} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
