"""A study compared with the same study at full cost: numbers within their errors, and seconds.

    make check-accuracy
    python benchmarks/check_accuracy.py config/paper.yaml

Every number that the first has is compared, in stages that rest on contact solves; how many points
a fit had is not one. It is right if it differs from that of the second by no more than its error
(``NAME_error`` in the atlas), or lies within its interval (``NAME_low``, ``NAME_high``); where
neither is stated, by no more than the relative accuracy asked of the closure.
"""

import argparse
import json
from collections import Counter

import numpy as np
from study_cost import stages_of

from fractalcontact.commands.verify import results_of
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.configuration import solver_settings

#: Stages that rest on contact solves.
_STAGES = (
    "closure",
    "dilatancy",
    "area",
    "strength",
    "windows",
    "domains",
    "scaling",
    "domain_measures",
    "size_test",
    "area_slope",
)
#: How the solver worked, not its result.
_ABOUT_THE_SOLVER = ("iterations", "residual", "solved")
_ENDINGS = ("_error", "_low", "_high", "_n")
#: Rounding of sums in another order.
_ROUNDING = 1e-9


def compared(ours, full, tolerance):
    """Verdicts on the numbers of one group: which kind of bound each had, and whether it held.

    Parameters
    ----------
    ours, full : xr.Dataset
    tolerance : float
        Relative error allowed of numbers that state no bound.

    Yields
    ------
    name : str
    kind : str
    right : (n,) bool ndarray
    """
    for name, found in ours.data_vars.items():
        skip = name in (*_ABOUT_THE_SOLVER, "n") or name.endswith(_ENDINGS) or name not in full
        if skip or found.dtype.kind not in "fiu":
            continue
        exact = full[name].values.astype(float)
        values = found.values.astype(float)
        known = np.isfinite(values)
        if not known.any():
            continue
        off = abs(values - exact)
        slack = _ROUNDING * abs(exact)
        if f"{name}_error" in ours:
            kind, within = "error", off <= ours[f"{name}_error"].values + slack
        elif f"{name}_low" in ours and ours[f"{name}_low"].shape == found.shape:
            low, high = (ours[f"{name}_{end}"].values for end in ("low", "high"))
            kind, within = "interval", (low - slack <= exact) & (exact <= high + slack)
            within |= off <= slack
        else:
            kind, within = "none stated", off <= tolerance * abs(exact) + slack
        yield name, kind, within[known]


def print_numbers(ours, full, tolerance):
    """How many numbers of an atlas lie within their bounds, and which lie outside most often."""
    numbers, right, outside = Counter(), Counter(), Counter()
    groups = {group.path: group for group in full.subtree}
    for group in ours.subtree:
        stage = group.path.strip("/").split("/")[0]
        if stage in _STAGES and group.path in groups:
            pair = (group.to_dataset(), groups[group.path].to_dataset())
            for name, kind, within in compared(*pair, tolerance):
                for bound in (kind, "all"):
                    numbers[bound] += within.size
                    right[bound] += np.count_nonzero(within)
                outside[f"{stage}: {name} ({kind})"] += np.count_nonzero(~within)
    for kind, n in sorted(numbers.items(), key=lambda item: item[1]):
        print(f"{kind:12s}{right[kind]:9d} of {n:9d} within: {right[kind] / n:.2%}")
    for name, n in outside.most_common(12):
        if n:
            print(f"  outside: {n:6d}  {name}")


def print_seconds(*results):
    """Seconds of solving in each stage of two studies, and their ratio."""
    ours, full = ({stage: row[2] for stage, row in stages_of(path)[0].items()} for path in results)
    for stage, seconds in full.items():
        if seconds > 0:
            print(f"solving {stage:18s}{ours.get(stage, 0.0):9.2f} s of {seconds:9.2f} s")
    a, b = sum(ours.values()), sum(full.values())
    print(f"solving {'all':18s}{a:9.2f} s of {b:9.2f} s: {b / a:.2f} times fewer")


def main():
    """Compare the results of the study given on the command line with those at full cost."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", help="a study that was run, also with 'accuracy: full'")
    ours_in = results_of(parser.parse_args().study)
    full_in = ours_in.with_name(f"{ours_in.name}_full")
    ours, full = (read_atlas(path / "atlas.nc") for path in (ours_in, full_in))
    config = json.loads(ours.attrs["configuration"])["study"]
    tolerance = solver_settings(config, str(ours_in)).accuracy["closure"]
    print_numbers(ours, full, tolerance)
    print_seconds(ours_in, full_in)


if __name__ == "__main__":
    main()
