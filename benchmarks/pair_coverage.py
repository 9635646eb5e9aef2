"""Coverage of the intervals of scanned pairs whose truth is known: `pair_coverage.py`.

    python benchmarks/pair_coverage.py --seeds 60

Two synthetic faces of one joint are "scanned": noise and outliers are put on both, and the upper
face is shifted, turned and tilted, as two scans in one frame are. The study reads them as any pair,
by the reading that its seed draws: as scanned, with outliers filled, or as given. The truth is the
contact of the faces without all that, in the same window, on the same grid. The table says how many
of the determined intervals hold it; of other windows of the true faces, how many of their mean gaps
lie in the interval of the whole joint.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from calibration import write_rows
from scipy import ndimage

from fractalcontact.core.errors import InputError
from fractalcontact.core.limits import REFERENCE_PRESSURES
from fractalcontact.core.reported import Reported
from fractalcontact.core.settings import Settings, Solver
from fractalcontact.core.subject import Subject
from fractalcontact.core.window import window_sides, window_slices
from fractalcontact.domain.analysis import analyse_domains
from fractalcontact.error_budget.closure_constants import seated_constants
from fractalcontact.joint.joint import describe_joint
from fractalcontact.joint.jrc import profile_roughness
from fractalcontact.joint.openings import prefractal_openings
from fractalcontact.laws.closure import closure_curves
from fractalcontact.laws.reference_states import reference_stiffness
from fractalcontact.laws.seated_laws import at_reference_pressures
from fractalcontact.report.published import read, row_of
from fractalcontact.stages.closure_and_box_counts import reported_budget
from fractalcontact.stages.specimen import specimen_of_files
from fractalcontact.states.loading import JointLoading, Variant
from fractalcontact.states.other_windows import whole_composite, window_places
from fractalcontact.states.seat import closure_from
from fractalcontact.states.state_quantities import SOUND, composite_quantities
from fractalcontact.states.state_scalars import aperture
from fractalcontact.states.states import (
    combine,
    contact_domains,
    forces_of,
    map_states,
    with_pressure,
)
from fractalcontact.states.sweep import joint_states, load_steps
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine
from roughcontact.errors import NotConverged

SPACING = 0.3  # mm
#: Rms of the faces and of what they differ by, mm, and roll-off of that, mm.
RMS, MISMATCH, MATED_BEYOND = 1.0, 0.12, 6.0
#: Errors of a scan: noise (mm), fraction of cells that are outliers, their size (mm).
NOISE, OUTLIERS, OUTLIER = 0.01, 0.001, 0.3
#: Largest shift (mm), turn (radians) and tilt of the upper face.
SHIFT, TURN, TILT = 0.15, 0.001, 0.0005
READINGS = ({}, {"outliers": "fill"}, {"registration": "none"})
OPTIONS = {
    **{"kind": "face", "layout": "matrix", "delimiter": "comma", "decimal": ".", "header": 0},
    **{"missing": "none", "heights": "up", "unit": "mm", "spacing": f"{SPACING} mm"},
    **{"axes": "none", "first_row": "bottom"},
}
STUDY: dict[str, Any] = {
    "study": "coverage",
    "materials": {
        "granite": {
            **{"modulus": "60 GPa", "poisson": 0.25},
            **{"basic_friction_angle": "30 deg", "joint_wall_strength": "150 MPa"},
            "hardness": "150 MPa",
        }
    },
    "defaults": {
        **{"material": "granite", "contact_directions": ["E"], "offsets": ["0 mm"]},
        "loads": [f"{p} MPa" for p in (0.25, 0.5, 1, 2, 3.5, 5, 7, 10, 15)],
        **{"resolutions": [1], "map_load": "5 MPa", "dilatancy_loads": ["1 MPa", "5 MPa"]},
    },
}
#: Quantities of the register compared under the reference pressures, and those without a load.
AT_LOADS = ("tangent_stiffness", "interface_closure", "seated_closure", "mean_gap")
SINGLE = ("k_ni", "v_m", "chi", "jrc")
QUANTITIES = (*AT_LOADS, *SINGLE, "mean_gap of other windows")


def true_faces(seed: int, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Heights of both faces (cells, cells) of a joint that was never scanned, mm."""
    shape = (cells, cells)
    lower = self_affine(shape, SPACING, 0.8, rms=RMS, seed=seed)
    apart = self_affine(
        shape, SPACING, 0.7, rms=MISMATCH, seed=seed + 500_000, roll_off=MATED_BEYOND
    )
    return lower, lower + apart + 3 * MISMATCH


def scanned(heights: np.ndarray, rng: np.random.Generator, *, moved: bool) -> np.ndarray:
    """Heights as an instrument reads them: with noise and outliers, and another frame if moved."""
    rows, columns = np.indices(heights.shape) * SPACING
    heights = heights.copy()
    if moved:
        turn, (dy, dx) = rng.uniform(-TURN, TURN), rng.uniform(-SHIFT, SHIFT, 2)
        middle = SPACING * (len(heights) - 1) / 2
        y, x = rows - middle, columns - middle
        places = middle + np.array([y + turn * x + dy, x - turn * y + dx])
        heights = ndimage.map_coordinates(heights, places / SPACING, order=3, mode="nearest")
        heights += rng.uniform(-TILT, TILT) * x + rng.uniform(-TILT, TILT) * y
    heights += NOISE * rng.standard_normal(heights.shape)
    is_outlier = rng.random(heights.shape) < OUTLIERS
    heights[is_outlier] += OUTLIER * rng.standard_normal(np.count_nonzero(is_outlier))
    return heights


def study_of(
    faces: tuple[np.ndarray, np.ndarray], reading: Mapping[str, str], side: float
) -> tuple[Subject, JointLoading]:
    """A pair as a study reads and solves it, and its loading."""
    own = {"window": f"{side} mm"} | {k: v for k, v in reading.items() if k == "outliers"}
    options = OPTIONS | {k: v for k, v in reading.items() if k == "registration"}
    settings = resolve_settings(STUDY, "pair", own, "coverage")
    solver = solver_settings({}, "coverage")
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"pair.{face}.csv" for face in ("lower", "upper")]
        for path, heights in zip(paths, faces, strict=True):
            np.savetxt(path, heights, delimiter=",", fmt="%.6f")
        specimen = specimen_of_files(paths, options, settings, "pair")
    joint = describe_joint(specimen, settings)
    parts = joint_states(
        specimen, joint, ["E"], slice(None), settings, settings.resolutions, solver
    )
    states = combine([parts])
    curves = closure_curves(
        states,
        window_sides(specimen),
        settings.material.e_star,
        openings=prefractal_openings(specimen, joint, settings.resolutions),
        seating_pressure=settings.seating_pressure,
    )
    loading = JointLoading.of_joint(specimen, joint, "E", settings, solver)
    reported = Reported.choose(
        curves,
        direction="E",
        offset=0.0,
        loads=forces_of(settings.dilatancy_loads, loading.area),
        reference=float(forces_of([settings.map_load], loading.area)[0]),
    )
    curves.update(reported.variables())
    stages = {"closure": curves, "domains": analyse_domains(contact_domains(states), SPACING)}
    stages = {name: with_pressure(stage, loading.area) for name, stage in stages.items()}
    stated = reference_stiffness(loading.at_map_offset(), stages["closure"], map_states([parts]))
    stages["closure"] = stages["closure"].assign(stated)
    budget = reported_budget(loading, stages, reported)
    roughness = profile_roughness(specimen, "E").expand_dims(contact_direction=["E"])
    stages |= {"specimens": specimen, "error_budget": budget, "strength": roughness}
    return Subject(stages, {"material": {}}, "pair"), loading


def true_loading(
    faces: tuple[np.ndarray, np.ndarray], study: JointLoading, settings: Settings, solver: Solver
) -> JointLoading:
    """Loading of the true faces in the window of a study."""
    labelled = [
        xr.DataArray(
            heights,
            dims=("y", "x"),
            coords={axis: study.specimen[axis].values for axis in "yx"},
            attrs={"spacing_y": SPACING, "spacing_x": SPACING},
        )
        for heights in faces
    ]
    arguments = window_arguments(settings) | {"outliers": "keep"}
    specimen = make_specimen(*labelled, name="truth", **arguments)
    for key in ("y0", "x0", "ny", "nx"):
        specimen.attrs[f"window_{key}"] = study.specimen.attrs[f"window_{key}"]
    return JointLoading(specimen, "E", np.array([0]), settings, solver)


def truth_of(loading: JointLoading, seat: float, stated: float) -> dict[str, Any]:
    """True values: over :data:`core.limits.REFERENCE_PRESSURES`, or single ones.

    ``seat`` is the force from which the study counts, N, ``stated`` the lightest pressure that may
    seat the truth, MPa.
    """
    forces = loading.forces(loading.settings.loads)
    sound = np.zeros(loading.shape, bool)
    variant = Variant("truth", loading.composite(0), sound)
    values = {name: of[0] for name, of in composite_quantities(loading, [variant], forces).items()}
    pressure = forces / loading.area
    gaps = [
        float(aperture(state).mean())
        for state in load_steps(
            variant.composite, loading.half_space(loading.shape), forces, loading.solving, "truth"
        )
    ]
    at = [int(np.argmin(abs(pressure - p))) for p in REFERENCE_PRESSURES]
    seated = closure_from(values["closure"][np.newaxis], forces, seat)[0]
    fitted = seated_constants(pressure, values["closure"], values[SOUND] > 0, stated)
    return {
        "tangent_stiffness": at_reference_pressures(pressure, values["stiffness"]),
        "interface_closure": values["closure"][at],
        "seated_closure": seated[at],
        "mean_gap": np.array(gaps)[at],
        "jrc": float(profile_roughness(loading.specimen, "E")["jrc_of_law"]),
        **fitted,
    }


def other_gaps(loading: JointLoading, pressure: float) -> np.ndarray:
    """Mean gaps of other windows of the true faces under a pressure, mm."""
    whole = whole_composite(loading.specimen, "E", 0)
    places, _ = window_places(np.isfinite(whole), window_slices(loading.specimen))
    space = loading.half_space(loading.shape)
    gaps = []
    for place in places[1:]:
        force = [pressure * loading.area]
        (state,) = load_steps(whole[place], space, force, loading.solving, "other window")
        gaps.append(float(aperture(state).mean()))
    return np.array(gaps)


def compared(seed: int, cells: int, side: float) -> Iterator[tuple[str, float, float, float]]:
    """Quantity, truth and ends of each determined interval of one joint."""
    rng, reading = np.random.default_rng(seed), READINGS[seed % len(READINGS)]
    true = true_faces(seed, cells)
    faces = scanned(true[0], rng, moved=False), scanned(true[1], rng, moved=True)
    subject, loading = study_of(faces, reading, side)
    closure = subject["closure"]
    seat = float(Reported.read(closure).states(closure)["seating_pressure"]) * loading.area
    settings, solver = loading.settings, loading.solver
    truth = true_loading(true, loading, settings, solver)
    # The range of a law stands beside its constants: the truth is fitted from the same seat.
    seated = seat / loading.area
    values = truth_of(truth, seat, settings.seating_pressure if np.isnan(seated) else seated)
    for name in AT_LOADS:
        for number in read(row_of(name), subject):
            for k, pressure in enumerate(REFERENCE_PRESSURES):
                if np.isclose(number.at["pressure"], pressure) and _is_known(number, row_of(name)):
                    yield name, float(values[name][k]), *number.estimate.ends[1:]
    for name in SINGLE:
        row = row_of("jrc_of_law" if name == "jrc" else name)
        (number,) = read(row, subject)
        if _is_known(number, row):
            yield name, values[name], *number.estimate.ends[1:]
    pressure = REFERENCE_PRESSURES[1]
    for number in read(row_of("mean_gap"), subject):
        if np.isclose(number.at["pressure"], pressure) and np.isfinite(number.population):
            for gap in other_gaps(truth, pressure):
                ends = (number.value + sign * number.population for sign in (-1, 1))
                yield "mean_gap of other windows", gap, *ends


def _is_known(number, row) -> bool:
    """True of a determined number with an interval; closure is 0 at its seat by definition."""
    is_seat = bool(row.zero) and number.value == 0
    ends = np.isfinite(number.estimate.low) and np.isfinite(number.estimate.high)
    return not number.missing and number.determined and bool(ends) and not is_seat


def main(arguments: list[str]) -> None:
    """Solve the joints, write a row of each interval, and print the coverage."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--first", type=int, default=41_000, help="first seed")
    parser.add_argument("--seeds", type=int, default=60)
    parser.add_argument("--cells", type=int, default=96, help="nodes per side of the faces")
    parser.add_argument("--window", type=float, default=12.0, help="side of the window, mm")
    parser.add_argument("--output", type=Path, default=Path("pair_coverage.csv"))
    options = parser.parse_args(arguments)

    def rows():
        for seed in range(options.first, options.first + options.seeds):
            try:
                for name, true, low, high in compared(seed, options.cells, options.window):
                    found.setdefault(name, []).append((seed, true, low, high))
                    yield name, seed, true, low, high, low <= true <= high
            except (InputError, NotConverged) as error:
                sys.stderr.write(f"{seed}: {error}\n")

    found: dict[str, list[tuple[float, ...]]] = {}
    names = ("quantity", "seed", "true", "low", "high", "holds")
    write_rows(options.output, names, rows(), "")
    for name in QUANTITIES:
        of = np.array(found.get(name, []), float).reshape(-1, 4)
        if not len(of):
            continue
        seeds, true, low, high = of.T
        holds = np.mean((low <= true) & (true <= high))
        off = np.maximum(abs(true - (low + high) / 2), 1e-12)
        wide = np.median((high - low) / 2 / off)
        sys.stdout.write(
            f"{name:28} {np.unique(seeds).size:3d} joints {len(of):4d} intervals "
            f"{holds:6.1%} hold the truth, half-width over its distance {wide:.1f}\n"
        )


if __name__ == "__main__":
    main(sys.argv[1:])
