"""Coverage of the stated errors, on synthetic joints whose truth is known: `error_coverage.py`.

Each joint is solved at s, as a study does, and at s/2 and s/4, from which its errors are stated;
the truth is the same surface at s/8. The constants of `states/numerical_error.py` are calibrated
on seeds 1 to 100; of any others the table says whether they hold.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

from fractalcontact.error_budget.refinement import FACTORS, curve_errors
from fractalcontact.roughness.dimension import slope_statistics
from fractalcontact.states.state_quantities import STATE_QUANTITIES, state_quantities
from fractalcontact.states.state_scalars import state_errors
from fractalcontact.states.subgrid import subgrid_states, summit
from fractalcontact.surface.synthesis import self_affine
from roughcontact.elastic.halfspace import HalfSpace

SPACING, MODULUS, RMS = 0.1, 1e4, 0.1  # mm, MPa, mm
#: Nominal pressures in E* h'_rms. At the last, far beyond joints of rock, some windows without a
#: roll-off carry like a punch.
LOADS = (0.001, 0.004, 0.02)
#: Divisor of the spacing of the truth, and tolerances of published, refined and true states.
TRUE, TOLERANCES = 8, {1: 1e-3, 2: 1e-4, 4: 1e-4, 8: 1e-5}


def joint(seed, cells):
    """Composite topography: slid by two or five cells or flat, H 0.5 or 0.8, roll-off or none."""
    hurst = (0.5, 0.8)[seed % 2]
    roll_off = (None, cells * SPACING / 8)[seed // 2 % 2]
    slid = (0, 2, 5)[seed % 3]
    shape = (cells, cells + slid)
    face = self_affine(shape, SPACING, hurst, rms=RMS, seed=10_000 + seed, roll_off=roll_off)
    return face[:, slid:] - face[:, :cells] if slid else face


def stated_and_true(heights, loads):
    """Total errors stated from three and from two spacings, and true ones: (3, quantity, load)."""
    space = HalfSpace(heights.shape, (SPACING, SPACING), MODULUS)
    slope = float(slope_statistics(heights, (SPACING, SPACING))["rms_slope"])
    pressure = np.array(loads) * MODULUS * slope
    forces = pressure * heights.size * SPACING**2
    values, raw, solver = {}, [], []
    for factor in (*FACTORS, TRUE):
        solving = {"rtol": TOLERANCES[factor]}
        states = list(subgrid_states(heights, space, factor, forces, solving, "joint"))
        numbers = [state_quantities(state, highest) for state, highest in states]
        values[factor] = np.array([[of[name] for of in numbers] for name in STATE_QUANTITIES])
        if factor == 1:
            raw = np.array([state.area for state, _ in states])
            solver = solver_errors([state for state, _ in states], forces)
    levels = np.array([values[factor] for factor in FACTORS])
    length = pressure / levels[0, list(STATE_QUANTITIES).index("stiffness")]
    rise = summit(heights) - float(heights.max())
    fewer = levels.copy()
    fewer[2] = np.nan
    stated = [np.hypot(curve_error_rows(of, raw, length, rise), solver) for of in (levels, fewer)]
    return np.array([*stated, abs(levels[0] - values[TRUE])])


def curve_error_rows(levels, raw_area, length, rise):
    """Numerical errors (quantity, load) from the values (spacing, quantity, load)."""
    by_name = dict(zip(STATE_QUANTITIES, levels.swapaxes(0, 1), strict=True))
    errors = curve_errors(by_name, raw_area, length, rise)
    return np.array([errors[name].error for name in STATE_QUANTITIES])


def solver_errors(states, forces):
    """Solver error bounds of the quantities, (quantity, load)."""
    rows = []
    for state in states:
        bounds = state_errors(state)
        numbers = state_quantities(state, 0.0)
        area = np.prod(np.multiply(state.space.shape, state.space.spacing))
        share = (numbers["stiffness"] * area / state.stiffness) ** 2
        rows.append(
            [
                bounds["closure_error"],
                bounds["closure_error"],
                bounds["area_corrected_error"],
                bounds["stiffness_error"] / area * share,
            ]
        )
    return np.array(rows).T


def cells_of(seed, cells):
    """Nodes per side of a joint: every fourth has half as many again."""
    return cells * 3 // 2 if seed % 4 == 0 else cells


def main(arguments):
    """Solve the joints, write a row of each quantity and load, and print the coverage."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=101, help="first seed")
    parser.add_argument("--joints", type=int, default=100)
    parser.add_argument("--cells", type=int, default=64, help="nodes per side at s")
    parser.add_argument("--loads", type=float, nargs="+", default=list(LOADS))
    parser.add_argument("--output", type=Path, default=Path("error_coverage.csv"))
    options = parser.parse_args(arguments)
    seeds = range(options.first, options.first + options.joints)
    found = np.array(
        [stated_and_true(joint(s, cells_of(s, options.cells)), options.loads) for s in seeds]
    )
    with options.output.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["seed", "quantity", "load", "stated", "stated from s/2", "true"])
        for (i, j, k), true in np.ndenumerate(found[:, 2]):
            name, load = list(STATE_QUANTITIES)[j], options.loads[k]
            rows.writerow([seeds[i], name, load, *found[i, :2, j, k], true])
    stated, true = found[:, :2], found[:, 2:]
    known = np.isfinite(stated) & np.isfinite(true)
    covers = np.where(known, stated >= true, np.nan)
    with np.errstate(all="ignore"):
        ratio = np.where(known, stated / true, np.nan)
    sys.stdout.write(
        "quantity          load  joints  covered from s/4  stated/true  from s/2  stated/true\n"
    )
    for j, name in enumerate(STATE_QUANTITIES):
        for k, load in enumerate(options.loads):
            part = np.s_[:, :, j, k]
            three, two = np.nanmean(covers[part], axis=0)
            by_three, by_two = np.nanmedian(ratio[part], axis=0)
            sys.stdout.write(
                f"{name:16} {load:5g} {known[part][:, 0].sum():7d} {three:17.3f} {by_three:12.2f} "
                f"{two:9.3f} {by_two:12.2f}\n"
            )


if __name__ == "__main__":
    main(sys.argv[1:])
