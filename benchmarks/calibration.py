"""Calibration of the intervals of Delta_sigma: `calibration.py`.

Over seeds that nobody chose, the stated half-width over 1.96 standard deviations of the value, and
how often the interval holds the truth: of random fractals their dimension, of contact domains the
mean over the seeds. Box counts are fitted over each state's own range, and over one common to all
seeds, the median of these; A_r(s) over three or four resolutions.
"""

import argparse
import csv
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from fractalcontact.core.intervals import LEFT_OUT
from fractalcontact.core.limits import CORRECTED_NODES
from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.domain.renormalisation import renormalisation
from fractalcontact.joint.joint import prefractal
from fractalcontact.states.area_sampling import state_area_sampling
from fractalcontact.states.left_out import fractions_left, part_ends
from fractalcontact.states.state_scalars import state_area
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

#: Seeds are those from here on.
FIRST_SEED = 20_000

#: Random fractals of the plane: parts a side, generations, parts kept of each (all with one
#: probability, or this many), and the dimension.
FRACTALS = {
    "percolation 1.5": (2, 9, 2**-0.5),
    "percolation 1.8": (2, 9, 2**-0.2),
    "random carpet": (3, 6, 8),
    "random dust": (3, 6, 4),
}


class Twin(NamedTuple):
    """A joint of a kind: lengths in mm, modulus E* and hardness in MPa."""

    face: int
    """Nodes a side of the face that the window is cut from."""
    window: int
    spacing: float
    hurst: float
    roll_off: float | None
    slid: int
    """Offset, nodes."""
    modulus: float
    hardness: float


#: Joints as config/paper.yaml has them, cut from larger faces.
TWINS = {
    "sandstone": Twin(500, 200, 0.1, 0.79, 5.0, 3, 10417, np.inf),
    "sandstone, capped": Twin(500, 200, 0.1, 0.79, 5.0, 3, 10417, 80.0),
    "joint 2.1": Twin(1024, 512, 0.0390625, 0.9, None, 8, 10417, np.inf),
    "joint 2.5": Twin(1024, 512, 0.0390625, 0.5, None, 8, 10417, np.inf),
}
RMS = 0.3  # mm, of the face
PRESSURES = (2.5, 10.0, 25.0)  # MPa
RESOLUTIONS = (1, 2, 4, 8)
#: Standard deviation up to which a value is the same for all seeds.
EXACT = 1e-6


def random_fractal(parts, generations, kept, seed):
    """Random set of parts^generations cells a side, and its dimension."""
    rng, cells = np.random.default_rng(seed), np.ones((1, 1), bool)
    for _ in range(generations):
        shape = (*cells.shape, parts**2)
        draw = rng.random(shape)
        stays = draw < kept if kept < 1 else draw.argsort(axis=2).argsort(axis=2) < kept
        stays = stays.reshape(*cells.shape, parts, parts).transpose(0, 2, 1, 3)
        side = parts * cells.shape[0]
        cells = stays.reshape(side, side) & np.kron(cells, np.ones((parts, parts), bool))
    of_part = kept * parts**2 if kept < 1 else kept
    return cells, np.log(of_part) / np.log(parts)


def states_of(twin, seed):
    """Contact domain at the finest resolution and Delta_sigma by A_r(s), by pressure."""
    face = self_affine(
        (twin.face, twin.face), twin.spacing, twin.hurst, rms=RMS, seed=seed, roll_off=twin.roll_off
    )
    y, x = ((twin.face - twin.window) // 2,) * 2
    rows = face[y : y + twin.window]
    composite = rows[:, x + twin.slid : x + twin.slid + twin.window] - rows[:, x : x + twin.window]
    found = {}
    for k in RESOLUTIONS:
        heights, spacing = prefractal(composite, k), k * twin.spacing
        space = HalfSpace(heights.shape, (spacing, spacing), twin.modulus)
        state = None
        for pressure in PRESSURES:
            force = pressure * heights.size * spacing**2
            state = solve_contact(
                heights, space, force=force, start=state, rtol=1e-4, hardness=twin.hardness
            )
            found.setdefault(pressure, []).append(state)
    domains = {pressure: states[0].in_contact for pressure, states in found.items()}
    return domains, {pressure: by_areas(states) for pressure, states in found.items()}


def by_areas(states):
    """Delta_sigma by A_r(s) with the ends of its interval, from states at `RESOLUTIONS`."""
    domains = [state.in_contact for state in states]
    ends = part_ends(domains[0], 1)
    s = xr.DataArray([state.space.spacing[0] for state in states], dims="resolution")
    area, nodes, sampling, left = (
        xr.DataArray(np.array(values, float), dims=("resolution", LEFT_OUT)[: np.ndim(values)])
        for values in (
            [state_area(state) for state in states],
            [domain.sum() for domain in domains],
            [state_area_sampling(state) for state in states],
            [fractions_left(*of, ends) for of in zip(domains, RESOLUTIONS, strict=True)],
        )
    )
    scaling = renormalisation(s, area, xr.DataArray(1.0), nodes, CORRECTED_NODES, left, sampling)
    return [float(scaling[f"delta_sigma{end}"]) for end in ("", "_low", "_high")]


def calibration(estimates, truth=None):
    """Number of intervals, mean, standard deviation, stated over 1.96 of these, and coverage."""
    value, low, high = np.transpose(estimates)
    known = np.isfinite(high - low)
    value, low, high = value[known], low[known], high[known]
    if value.size < 2:
        return value.size, np.nan, np.nan, np.nan, np.nan
    sd = value.std(ddof=1)
    half = (high - low) / 2
    truth = value.mean() if truth is None else truth
    if sd < EXACT:  # as that of yielding contacts, whose area is F/H at all resolutions
        return value.size, value.mean(), 0.0, np.nan, np.mean(half < EXACT)
    covered = np.mean((low <= truth) & (truth <= high))
    return value.size, value.mean(), sd, np.mean(half) / (1.96 * sd), covered


def by_boxes(domains, spacing):
    """Delta_sigma by boxes over each domain's own range and over their median range."""
    own = [dimension_of_domain(domain, spacing) for domain in domains]
    common = np.nanmedian([box.over for box in own], axis=0)
    shared = [dimension_of_domain(domain, spacing, fit_range=tuple(common)) for domain in domains]
    return {"own range": own, "common range": shared}


def rows(seeds):
    """Rows of the table: set, estimate, and the numbers of :func:`calibration`."""
    for name, how in FRACTALS.items():
        drawn = [random_fractal(*how, seed) for seed in seeds]
        domains = [cells for cells, _ in drawn if cells.sum() > 1]
        for range_of, boxes in by_boxes(domains, 1.0).items():
            ends = [box.ends for box in boxes]
            yield name, "boxes", range_of, *calibration(ends, drawn[0][1])
    for name, twin in TWINS.items():
        solved = [states_of(twin, seed) for seed in seeds]
        for pressure in PRESSURES:
            of = f"{name}, {pressure:g} MPa"
            domains = [domains[pressure] for domains, _ in solved]
            for range_of, boxes in by_boxes(domains, twin.spacing).items():
                yield of, "boxes", range_of, *calibration([box.ends for box in boxes])
            yield of, "A_r(s)", "", *calibration([areas[pressure] for _, areas in solved])


def main(arguments):
    """Measure all, write the table as CSV and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=FIRST_SEED, help="first seed")
    parser.add_argument("--seeds", type=int, default=60)
    parser.add_argument("--output", type=Path, default=Path("calibration.csv"))
    options = parser.parse_args(arguments)
    seeds = range(options.first, options.first + options.seeds)
    names = ("set", "by", "range", "n", "mean", "sd", "stated / 1.96 sd", "coverage")
    sys.stdout.write("{:30} {:7} {:13} {:>3} {:>6} {:>6} {:>6} {:>6}\n".format(*names))
    line = "{:30} {:7} {:13} {:3d} {:6.3f} {:6.3f} {:6.2f} {:6.2f}\n"
    write_rows(options.output, names, rows(seeds), line)


def write_rows(path, names, found, line):
    """Write rows as CSV, and print each in the form of a line, as it is found."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(names)
        for row in found:
            table.writerow(row)
            file.flush()
            sys.stdout.write(line.format(*row))
            sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
