"""How far the numbers of a real joint depend on how its scans are treated, and if that is said.

    python benchmarks/pair_variants.py config/paper.yaml granite
    python benchmarks/pair_variants.py my_study.yaml slab --offset 0.6

The specimen is prepared and pressed as it is, and in the ways a user may choose as well: without
registration, gridded twice as coarsely, in a smaller window, in another one, with outliers masked,
with suspicious cells filled. For each: k_ni of the hyperbola through states of ten nodes and more;
tangent stiffness, closure from first contact, separation of the mean planes and contact area under
the map load; the fraction of that load on suspicious cells. Errors are half-widths of 95 %:
registration, counting of the nodes, scatter of the highest node (closure and k_ni, which begin
there), and the change from twice the spacing. A number is undetermined where suspicious cells carry
more than half of the load it follows from, or its error is as large as itself. Variants of one
window must agree within their errors; another window is another piece of rock.
"""

import argparse
import csv
import sys
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fractalcontact.core.directions import slides
from fractalcontact.core.errors import InputError
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.limits import DECISIVE
from fractalcontact.core.settings import Settings, Solver
from fractalcontact.core.window import cell_side, window_sides
from fractalcontact.error_budget.two_scans import registration_spread, registration_values
from fractalcontact.joint.joint import describe_joint, prefractal
from fractalcontact.laws.closure import closure_curves
from fractalcontact.laws.closure_laws import fit_hyperbola
from fractalcontact.laws.scan_errors import fits_undetermined
from fractalcontact.registration.registration_scatter import motion_variables, scattered_motions
from fractalcontact.roughness.quality import scan_quality
from fractalcontact.roughness.quality_words import overlap_words, suspect_words
from fractalcontact.scan.read import read_faces
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.states import combine, forces_of
from fractalcontact.states.sweep import contact_states
from fractalcontact.study.checks import read_sidecar
from fractalcontact.study.configuration import (
    resolve_settings,
    solver_settings,
)
from fractalcontact.study.documents import read_study
from fractalcontact.study.scan_files import list_scans
from fractalcontact.surface.specimen import make_specimen, window_arguments

#: Of the smaller window, to the automatic one; and how far the other window lies from it.
SMALLER, ASIDE = 0.56, 0.35
#: States of fewer nodes enter no fit.
MIN_NODES = 10
QUANTITIES = {
    "k_ni": "MPa/mm",
    "stiffness": "MPa/mm",
    "closure": "mm",
    "separation": "mm",
    "area_corrected": "mm2",
}


def variants(specimen, faces: int, points: bool) -> Iterator[tuple[str, dict, dict]]:
    """Names of variants with keys of the sidecar for the scan, and for the study."""
    side, spacing = min(window_sides(specimen)), cell_side(specimen)
    rows, columns = (int(specimen.attrs[f"window_{axis}0"]) for axis in "yx")
    middle = [
        float(specimen[axis].values[start]) + side / 2
        for axis, start in zip("xy", (columns, rows), strict=True)
    ]
    centre = middle[0] - ASIDE * side, middle[1] + ASIDE * side
    aside = {"window_centre": [f"{at:.6g} mm" for at in centre]}
    smaller = {"window": f"{SMALLER * side:.4g} mm"}
    coarser = {"grid": f"{2 * spacing:.6g} mm"}
    yield "as it is", {}, {}
    if faces == 2:
        yield "without registration", {"registration": "none"}, {}
    if points:
        yield "grid twice as coarse", coarser, {}
    yield "smaller window", {}, smaller
    yield "outliers masked, other window", {}, smaller | aside | {"outliers": "mask"}
    fill = {"outliers": "fill"}
    yield "filled", {}, fill
    if faces == 2:
        yield "filled, without registration", {"registration": "none"}, fill
    if points:
        yield "filled, grid twice as coarse", coarser, fill
    yield "filled, smaller window", {}, fill | smaller
    yield "filled, other window", {}, fill | smaller | aside


def numbers(specimen, settings: Settings, solver: Solver, wanted: float) -> dict:
    """Quantities of a specimen with errors, at the offset nearest to the one wanted (mm)."""
    joint = describe_joint(specimen, settings)
    loading = JointLoading.of_joint(
        specimen, joint, settings.contact_directions[0], settings, solver
    )
    cells = loading.cells[np.argmin(abs(loading.offsets - wanted))]
    loading = loading.at(cells)
    states = combine([contact_states(loading, [1, 2], map_cells=cells)])
    e_star = settings.material.e_star
    curves = closure_curves(states, window_sides(specimen), e_star).isel(direction=0, offset=0)
    (force,) = forces_of([settings.map_load], loading.area)
    at, coarse = (
        curves.sel(resolution=k).sel(normal_force=force, method="nearest") for k in (1, 2)
    )
    heights = loading.composite(int(cells))
    spans = {k: np.max(h) - np.mean(h) for k, h in ((1, heights), (2, prefractal(heights, 2)))}
    fine = curves.sel(resolution=1)
    hyperbolas = {k: fitted_hyperbola(curves.sel(resolution=k), loading.area) for k in (1, 2)}
    values, coarser = (
        {
            "k_ni": hyperbolas[k].k_ni.value,
            "stiffness": float(state["interface_stiffness"]),
            "closure": float(state["interface_closure"]),
            "separation": spans[k] - float(state["closure"]),
            "area_corrected": float(state["area_corrected"]),
        }
        for k, state in ((1, at), (2, coarse))
    )
    counting = 1.96 / np.sqrt(max(float(at["nodes"]), 1.0))
    # Scatter of the highest node, as of error_budget/counting.py.
    decay = float(at["nominal_pressure"]) / values["stiffness"]
    highest = 1.96 * np.pi / np.sqrt(6) * decay
    own = {
        "stiffness": counting * values["stiffness"],
        "area_corrected": counting * values["area_corrected"],
        "closure": highest,
        "k_ni": np.hypot(
            hyperbolas[1].k_ni.width / 2,
            values["k_ni"] * highest / hyperbolas[1].lowest,
        ),
    }
    at_load = registration_values(loading, [settings.map_load])
    of_motion = registration_spread(at_load, np.array([force]), np.nan) or {}
    errors = {}
    for name, value in values.items():
        moved = float(of_motion.get(name, [0.0])[0])
        parts = [coarser[name] - value, own.get(name, 0.0), moved]
        errors[name] = float(np.sqrt(np.nansum(np.square(parts))))
    if not np.isfinite(coarser["k_ni"]):  # nothing is known of how it converges
        errors["k_ni"] = np.nan
    share = float(at["suspect_load_share"])
    undetermined = {
        name: share > DECISIVE or not errors[name] < abs(value) for name, value in values.items()
    }
    undetermined["k_ni"] |= bool(fits_undetermined(fine))
    return {
        "values": values,
        "errors": errors,
        "undetermined": undetermined,
        "share": share,
        "nodes": int(at["nodes"]),
        "offset": float(loading.offsets[0]),
    }


class Fit(NamedTuple):
    """k_ni with its interval, and the closure at the lightest load fitted."""

    k_ni: Estimate
    lowest: float


def fitted_hyperbola(curve, area: float) -> Fit:
    """The hyperbola through states of enough nodes."""
    fitted = curve["nodes"].values >= MIN_NODES
    closures = curve["interface_closure"].values[fitted]
    pressure = curve["normal_force"].values[fitted] / area
    found = fit_hyperbola(pressure, closures)
    return Fit(found.k_ni, closures.min(initial=np.inf))


def table(study: Mapping, name: str, source: str, offset: float) -> Iterator[dict]:
    """One row a variant of a specimen."""
    scans, refused = list_scans(study["scans"])
    if name not in scans:
        raise InputError(str(refused.get(name, f"{study['scans']}: no scan {name}")))
    scan = scans[name]
    options, own = read_sidecar(scan.sidecar)
    solver = solver_settings(study, source)

    read: dict[str, tuple] = {}  # once in each way: that takes longer than the rest

    def prepared(of_scan: Mapping, of_study: Mapping):
        settings = resolve_settings(study, name, own | of_study, source)
        settings = replace(settings, resolutions=[1, 2])
        if slides(settings.opposite):  # this offset, and in the first direction alone
            first = settings.contact_directions[:1]
            settings = replace(
                settings, offsets=[offset], directions=first, contact_directions=first
            )
        key = str(sorted(of_scan.items()))
        if key not in read:
            faces = read_faces(scan.lower, scan.upper, options | of_scan)
            motions = [] if scan.upper is None else scattered_motions(*faces)
            read[key] = faces, motion_variables(motions) if motions else {}
        faces, motions = read[key]
        specimen = make_specimen(*faces, name=name, **window_arguments(settings))
        return specimen.assign(motions), settings

    whole, _ = prepared({}, {})
    # A whole number of cells of the coarse grid, too.
    offset = 2 * cell_side(whole) * round(offset / (2 * cell_side(whole)))
    points = "points" in whole.attrs["lower_scan"]
    for words, of_scan, of_study in variants(whole, int(whole.attrs["faces"]), points):
        try:
            specimen, settings = prepared(of_scan, of_study)
            found = numbers(specimen, settings, solver, offset)
        except InputError as error:
            sys.stderr.write(f"{words}: {error}\n")
            continue
        quality = scan_quality(specimen, settings.resolutions)
        lights = [overlap_words(specimen, quality), suspect_words(specimen)]
        lights.append(quality.attrs["warning"])
        yield {"variant": words, **found, "lights": "; ".join(filter(None, lights)) or "ok"}


def flat(row: Mapping) -> dict:
    """A row of the file: numbers as text, undetermined ones marked."""
    cells = {"variant": row["variant"], "offset (mm)": f"{row['offset']:.3g}"}
    for name, unit in QUANTITIES.items():
        value, error = row["values"][name], row["errors"][name]
        mark = " undetermined" if row["undetermined"][name] else ""
        cells[f"{name} ({unit})"] = f"{value:.3g} +- {error:.2g}{mark}"
    cells["load on suspicious cells"] = f"{row['share']:.2f}"
    return cells | {"nodes": str(row["nodes"]), "lights": row["lights"]}


def verdicts(rows: list[dict]) -> Iterator[tuple[str, str, bool]]:
    """Of each quantity: whether the variants of the one window that determine it agree."""
    rows = [row for row in rows if "window" not in row["variant"]]
    for name in QUANTITIES:
        kept = [row for row in rows if not row["undetermined"][name]]
        words = f"determined in {len(kept)} of {len(rows)} variants"
        if len(kept) < 2:
            yield name, words, True
            continue
        values = np.array([row["values"][name] for row in kept])
        errors = np.array([row["errors"][name] for row in kept])
        # Each of two variants may be off by its own error.
        apart = np.abs(values[:, None] - values) / np.hypot(errors[:, None], errors)
        largest = float(apart.max())
        words += f", {values.min():.3g} to {values.max():.3g}, up to {largest:.2g} errors apart"
        yield name, words, largest <= 1


def main() -> int:
    """Print the table of a specimen and write it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", type=Path)
    parser.add_argument("specimen")
    parser.add_argument("--offset", type=float, default=0.0, help="mm")
    parser.add_argument("--output", type=Path, default=Path("results/benchmarks"))
    options = parser.parse_args()
    study = read_study(options.study)
    try:
        rows = list(table(study, options.specimen, str(options.study), options.offset))
    except InputError as error:
        sys.stderr.write(f"error: {error}\n")
        return 1
    options.output.mkdir(parents=True, exist_ok=True)
    path = options.output / f"pair_variants_{options.specimen}_{options.offset:g}.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(flat(rows[0])))
        writer.writeheader()
        writer.writerows(map(flat, rows))
    for row in rows:
        sys.stdout.write(f"{' | '.join(flat(row).values())}\n")
    for name, words, agree in verdicts(rows):
        sys.stdout.write(f"{name}: {words}{'' if agree else ': NOT WITHIN THEIR ERRORS'}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
