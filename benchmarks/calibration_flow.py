"""Calibration of the window interval of the transmissivity: `calibration_flow.py`.

Over seeds that nobody chose, the stated half-width of ln T over 1.96 standard deviations of its
values, and how often the interval holds the mean of ln T: by the four quarters of the window alone,
with the error of the mean gap as counts of contacts state it, and with the scatter of the mean gap
over the seeds, which is what twins or realisations know.
"""

import argparse
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import scipy.ndimage
import xarray as xr
from calibration import FIRST_SEED, PRESSURES, TWINS, write_rows
from calibration_sampling import SEAT, face_of

from fractalcontact.core.intervals import t_quantile
from fractalcontact.domain.clusters import NEIGHBOURS
from fractalcontact.error_budget.counting import counting_error
from fractalcontact.error_budget.refinement import LoadCurve
from fractalcontact.flow.aperture import MAX_CRUSHED
from fractalcontact.flow.cubic_law import GAP_POWER, flow_of, window_interval
from fractalcontact.states.area_sampling import state_area_sampling
from fractalcontact.states.state_scalars import aperture
from fractalcontact.states.subgrid import state_quantities
from fractalcontact.states.sweep import load_steps
from roughcontact.contact.path import loaded_state
from roughcontact.elastic.halfspace import HalfSpace

#: Joints of calibration.py, with windows that are solved in seconds: of the same length.
JOINTS = {
    "sandstone": {"face": 256, "window": 128, "spacing": 0.15, "slid": 2},
    "sandstone, capped": {"face": 256, "window": 128, "spacing": 0.15, "slid": 2},
    "joint 2.1": {"face": 256, "window": 128, "spacing": 0.15625, "slid": 2},
}
#: What states the interval, and by what the error of the mean gap is known.
STATED = ("quarters", "quarters, counting", "quarters, known scatter")


def states_of(joint, seed):
    """ln T, its half-width by quarters, mean gap and its half-width by counting: (4, load).

    T is NaN where the grid does not resolve the flow, or crushed rock may fill the gap.
    """
    face = face_of(joint, seed)
    composite = face[:, joint.slid :] - face[:, : -joint.slid]
    spacing = (joint.spacing,) * 2
    space = HalfSpace(composite.shape, spacing, joint.modulus)
    area = composite.size * joint.spacing**2
    forces = area * np.array([SEAT, *PRESSURES])
    solving = {"rtol": 1e-4, "hardness": joint.hardness}
    rows, flows = [], []
    for state in load_steps(composite, space, forces, solving, "calibration"):
        found = state_quantities(state, float(composite.max()))
        gap = aperture(state)
        row = {
            "area_share": state.in_contact.mean(),
            "area_corrected": found["area_corrected"],
            "area_sampling": state_area_sampling(state),
            "closure": state.closure,
            "stiffness": found["stiffness"],
            "interface_closure": found["closure"],
            "interface_stiffness": found["stiffness"],
            "mean_gap": gap.mean(),
            "clusters": scipy.ndimage.label(state.in_contact, NEIGHBOURS)[1],
        }
        rows.append(row | dict.fromkeys(("delta_sigma", "delta_sigma_low", "delta_sigma_high"), 0))
        flow = flow_of(gap, spacing, "x")
        crushed = loaded_state(state).permanent_set.mean() / gap.mean()
        stated = flow.resolved and crushed <= MAX_CRUSHED and flow.transmissivity > 0
        whole = flow.transmissivity if stated else np.nan
        quarters = window_interval(gap, spacing, "x", whole)
        flows.append((np.log(whole), np.log(quarters.high / whole)))
    table = {name: ("normal_force", [row[name] for row in rows]) for name in rows[0]}
    curve = xr.Dataset(table, {"normal_force": forces})
    loading = SimpleNamespace(area=area, half_space=lambda shape, resolution: space)
    counted = counting_error(LoadCurve(loading, composite, 0.0, 1, curve, curve))[1]
    return np.array([*np.transpose(flows), curve["mean_gap"].values, counted])[:, 1:]


def rows(seeds):
    """Rows of the table: joint, pressure, by what stated, and the numbers of both."""
    for name, of_window in JOINTS.items():
        joint = TWINS[name]._replace(**of_window)
        solved = np.array([states_of(joint, seed) for seed in seeds])
        for load, pressure in enumerate(PRESSURES):
            log_t, quarters, gap, counted = solved[:, :, load].T
            known = np.isfinite(log_t + quarters)
            if known.sum() < 2:
                continue
            truth, sd = log_t[known].mean(), log_t[known].std(ddof=1)
            scatter = t_quantile(np.inf) * gap.std(ddof=1) / gap.mean()
            for by, of_gap in zip(STATED, (0.0, counted / gap, scatter), strict=True):
                half = np.hypot(quarters, GAP_POWER * of_gap)[known]
                covered = np.abs(log_t[known] - truth) <= half
                ratio = half.mean() / (t_quantile(np.inf) * sd)
                yield name, pressure, by, int(known.sum()), truth, sd, ratio, covered.mean()


def main(arguments):
    """Measure all, write the table as CSV and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=FIRST_SEED, help="first seed")
    parser.add_argument("--seeds", type=int, default=60)
    parser.add_argument("--output", type=Path, default=Path("calibration_flow.csv"))
    options = parser.parse_args(arguments)
    seeds = range(options.first, options.first + options.seeds)
    names = ("joint", "pressure", "stated by", "n", "mean ln T", "sd")
    names += ("stated / 1.96 sd", "coverage")
    line = "{:18} {:5g} {:24} {:3d} {:9.4g} {:9.3g} {:6.2f} {:6.2f}\n"
    write_rows(options.output, names, rows(seeds), line)


if __name__ == "__main__":
    main(sys.argv[1:])
