"""Calibration of the sampling errors of one window: `calibration_sampling.py`.

Over seeds that nobody chose, the stated half-width of closure from a seat, mean gap, corrected
area, tangent stiffness (the slope of the closure curve) and both Delta_sigma over 1.96 standard
deviations of the values, and how often the interval holds their mean: as counts of contacts state
it, and twins of the window.
"""

import argparse
import functools
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import scipy.ndimage
import xarray as xr
from calibration import (
    EXACT,
    FIRST_SEED,
    PRESSURES,
    RESOLUTIONS,
    RMS,
    TWINS,
    by_areas,
    calibration,
    write_rows,
)

from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.domain.clusters import NEIGHBOURS
from fractalcontact.domain.random_nodes import band_of
from fractalcontact.error_budget.counting import counting_error
from fractalcontact.error_budget.refinement import LoadCurve
from fractalcontact.joint.joint import prefractal
from fractalcontact.roughness.twin_surface import twin_surface
from fractalcontact.states.area_sampling import state_area_sampling
from fractalcontact.states.state_quantities import state_quantities
from fractalcontact.states.state_scalars import aperture
from fractalcontact.states.sweep import load_steps
from fractalcontact.surface.synthesis import band_limited
from roughcontact.elastic.halfspace import HalfSpace

#: Joints of calibration.py, and of how many seeds the twins are solved.
JOINTS = {"sandstone": 30, "sandstone, capped": 20, "joint 2.1": 16}
#: Columns of Delta_sigma and the ends of its interval.
DELTA_SIGMA = ("delta_sigma", "delta_sigma_low", "delta_sigma_high")
#: Load that closures count from, MPa.
SEAT = 0.25
#: Quantities, and the rows of `counting_error` that are stated of them: none of a closure from a
#: seat, and of Delta_sigma by A_r(s) its interval.
QUANTITIES = {
    "closure from the seat": None,
    "mean gap": 1,
    "corrected area": 2,
    "stiffness": 3,
    "Delta_sigma": 4,
    "Delta_sigma by A_r(s)": None,
}


@functools.cache
def prefactor_of(joint):
    """Prefactor of the spectrum that makes faces of a joint as rough as RMS in the mean square."""
    faces = [_unscaled(joint, seed, 1.0) for seed in range(8)]
    return RMS**2 / np.mean(np.square(faces))


def _unscaled(joint, seed, prefactor):
    spectrum = {"cut_off": 2 * joint.spacing, "roll_off": joint.roll_off, "prefactor": prefactor}
    shape = (joint.face, joint.face)
    return band_limited(shape, joint.spacing, joint.hurst, seed=seed, **spectrum)


def face_of(joint, seed):
    """Part of a larger face that a window needs: its rows, and its columns with the offset.

    All faces have one spectrum. Scaled to one rms, those without a roll-off would differ by their
    longest wave in the amplitude of all others, of which no window knows.
    """
    first = (joint.face - joint.window) // 2
    last = first + joint.window
    return _unscaled(joint, seed, prefactor_of(joint))[first:last, first : last + joint.slid]


def solving_of(joint):
    """Arguments of the solver for a joint."""
    return {"rtol": 1e-4, "hardness": joint.hardness}


def counted_states(joint, face, more):
    """Composite, forces, numbers of the states of a window, and their half-widths by counting.

    ``more`` gives further numbers of a state by name, Delta_sigma with its interval among them.
    """
    composite = face[:, joint.slid :] - face[:, : -joint.slid]
    space = HalfSpace(composite.shape, (joint.spacing,) * 2, joint.modulus)
    area = composite.size * joint.spacing**2
    forces = area * np.array([SEAT, *PRESSURES])
    rows = []
    for state in load_steps(composite, space, forces, solving_of(joint), "calibration"):
        found = state_quantities(state, float(composite.max()))
        row = {
            "area_share": state.in_contact.mean(),
            "area_corrected": found["area_corrected"],
            "area_sampling": state_area_sampling(state),
            "closure": state.closure,
            "stiffness": found["stiffness"],
            "interface_closure": found["closure"],
            "interface_stiffness": found["stiffness"],
            "mean_gap": aperture(state).mean(),
            "clusters": scipy.ndimage.label(state.in_contact, NEIGHBOURS)[1],
        }
        rows.append(row | more(state))
    table = {name: ("normal_force", [row[name] for row in rows]) for name in rows[0]}
    curve = xr.Dataset(table, {"normal_force": forces})
    loading = SimpleNamespace(area=area, half_space=lambda shape, resolution: space)
    counted = counting_error(LoadCurve(loading, composite, 0.0, 1, curve, curve))
    return composite, forces, curve, counted


def states_of(joint, face):
    """Values (quantity, load) of a window, and half-widths by counting, NaN of none stated."""

    def dimension(state):
        boxes = dimension_of_domain(state.in_contact, joint.spacing)
        return dict(zip(DELTA_SIGMA, boxes.ends, strict=True))

    composite, forces, curve, counted = counted_states(joint, face, dimension)
    none = np.full(len(forces), np.nan)
    half = [none if row is None else counted[row] for row in QUANTITIES.values()]
    seated = curve["interface_closure"] - curve["interface_closure"][0]
    of_state = ("mean_gap", "area_corrected", "interface_stiffness", "delta_sigma")
    by_area, low, high = _by_areas(joint, composite, forces)
    half[-1] = (high - low) / 2
    values = [seated.values, *(curve[name].values for name in of_state), by_area]
    return np.array(values)[:, 1:], np.array(half)[:, 1:]


def _by_areas(joint, composite, forces):
    """Delta_sigma by A_r(s) with the ends of its interval, (3, load)."""
    found, solving = [], solving_of(joint)
    for k in RESOLUTIONS:
        heights = prefractal(composite, k)
        space = HalfSpace(heights.shape, (k * joint.spacing,) * 2, joint.modulus)
        found.append(load_steps(heights, space, forces, solving, "calibration"))
    return np.transpose([by_areas(states) for states in zip(*found, strict=True)])


def twin_half_widths(joint, face, seeds):
    """Half-widths (quantity, load) within which one more twin of a window lies."""
    window = face[:, : joint.window]
    surface = twin_surface(window, (joint.spacing,) * 2, face.shape)
    drawn = [states_of(joint, surface.drawn(seed))[0] for seed in seeds]
    return band_of(np.array(drawn)).width / 2


def rows(seeds, number):
    """Rows of the table: joint, pressure, quantity, by what stated, and the numbers of both."""
    for name, most in JOINTS.items():
        joint = TWINS[name]
        faces = [face_of(joint, seed) for seed in seeds]
        solved = [states_of(joint, face) for face in faces]
        values, counted = (np.array([one[k] for one in solved]) for k in (0, 1))
        by_twins = np.full(values.shape, np.nan)
        for i, face in enumerate(faces[:most]):
            # Of each window its own: chance common to all would look like an error of the method.
            by_twins[i] = twin_half_widths(joint, face, range(i * number + 1, (i + 1) * number + 1))
        for load, pressure in enumerate(PRESSURES):
            for k, quantity in enumerate(QUANTITIES):
                value = values[:, k, load]
                known = value[np.isfinite(value)]
                if known.size < 2:
                    continue
                truth, sd = known.mean(), known.std(ddof=1)
                if sd < EXACT * abs(truth):  # yielding contacts have the area F/H
                    continue
                for by, half in (("counting", counted), ("twins", by_twins)):
                    ends = np.stack([value, value - half[:, k, load], value + half[:, k, load]])
                    n, _, of_these, ratio, covered = calibration(ends.T, truth)
                    # Against the deviation over all seeds, of which not all may have twins.
                    yield name, pressure, quantity, by, n, truth, sd, ratio * of_these / sd, covered


def main(arguments):
    """Measure all, write the table as CSV and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=FIRST_SEED, help="first seed")
    parser.add_argument("--seeds", type=int, default=60)
    parser.add_argument("--twins", type=int, default=20, help="twins of each window")
    parser.add_argument("--output", type=Path, default=Path("calibration_sampling.csv"))
    options = parser.parse_args(arguments)
    seeds = range(options.first, options.first + options.seeds)
    names = ("joint", "pressure", "quantity", "stated by", "n", "mean", "sd")
    names += ("stated / 1.96 sd", "coverage")
    line = "{:18} {:5g} {:22} {:9} {:3d} {:9.4g} {:9.3g} {:6.2f} {:6.2f}\n"
    write_rows(options.output, names, rows(seeds, options.twins), line)


if __name__ == "__main__":
    main(sys.argv[1:])
