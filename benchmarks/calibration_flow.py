"""Calibration of the window interval of the transmissivity: `calibration_flow.py`.

Over seeds that nobody chose, the stated half-width of ln T over 1.96 standard deviations of its
values, and how often the interval holds the mean of ln T: by the four quarters of the window alone,
with the error of the mean gap as counts of contacts state it, and with the scatter of the mean gap
over the seeds, which is what twins or realisations know.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from calibration import FIRST_SEED, PRESSURES, TWINS, write_rows
from calibration_sampling import DELTA_SIGMA, counted_states, face_of

from fractalcontact.core.intervals import t_quantile
from fractalcontact.flow.aperture import MAX_CRUSHED
from fractalcontact.flow.cubic_law import GAP_POWER, flow_of, window_interval
from fractalcontact.states.state_scalars import aperture
from roughcontact.contact.path import loaded_state

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
    spacing = (joint.spacing,) * 2

    def flow(state):
        gap = aperture(state)
        flow = flow_of(gap, spacing, "x")
        crushed = loaded_state(state).permanent_set.mean() / gap.mean()
        is_stated = flow.resolved and crushed <= MAX_CRUSHED and flow.transmissivity > 0
        whole = flow.transmissivity if is_stated else np.nan
        quarters = window_interval(gap, spacing, "x", whole)
        numbers = {"log_t": np.log(whole), "quarters": np.log(quarters.high / whole)}
        return numbers | dict.fromkeys(DELTA_SIGMA, 0)  # not wanted

    *_, curve, counted = counted_states(joint, face_of(joint, seed), flow)
    numbers = [curve[name].values for name in ("log_t", "quarters", "mean_gap")]
    return np.array([*numbers, counted[1]])[:, 1:]


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
