"""Elastic contact and contact that crushes on grids of s/2, s, 2s and 4s: what converges.

    python benchmarks/grid_table.py                         twins and joint of the default study
    python benchmarks/grid_table.py --specimens granite     a scan of it; its rows are added

Each specimen is loaded at its reported offset on the composite topography of its window (s), on
the cubic spline through it (s/2: the same surface) and on every second and fourth node (2s, 4s:
another surface), elastic and with its pressure capped at 3 and 1 times the joint wall strength
(JCS). Closure counts from one seating pressure on all grids. All loads go to
``docs/grid_table.csv``, where rows of other specimens stay; from it the table of
docs/verification.md is written, under one pressure.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from fractalcontact.core.errors import InputError
from fractalcontact.core.settings import Settings, Solver
from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.joint.joint import describe_joint, prefractal
from fractalcontact.stages.specimen import prepare_specimen
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.state_quantities import state_quantities
from fractalcontact.states.subgrid import subgrid
from fractalcontact.states.sweep import load_steps
from fractalcontact.study.checks import read_sidecar
from fractalcontact.study.configuration import (
    resolve_embedded,
    resolve_settings,
    solver_settings,
)
from fractalcontact.study.documents import read_study
from fractalcontact.study.embedded import write_scan
from fractalcontact.study.scan_files import list_scans
from fractalcontact.study.sidecar import sidecar_of_matrix
from fractalcontact.surface.embedded import embedded_surface
from roughcontact.contact.state import ContactState

ROOT = Path(__file__).parents[1]
TABLE, PAGE = ROOT / "docs/grid_table.csv", ROOT / "docs/verification.md"
BEGIN, END = "<!-- grid table: make grid-table -->", "<!-- end of the grid table -->"
#: Multiples of the scan's spacing, as they are called.
GRIDS = {0.5: "s/2", 1: "s", 2: "2s", 4: "4s"}
#: Hardness over the joint wall strength.
MODELS = {"elastic": np.inf, "3 JCS": 3.0, "JCS": 1.0}
#: Nominal pressures, MPa: the seat, and up to two decades above it.
PRESSURES = (0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 15.0, 25.0)
#: Columns of the file that the page shows: heading, number format.
SHOWN = {
    "closure_mm": ("closure from the seat, mm", "{:.3f}"),
    "area": ("real contact area A_r / A_0, not corrected for the perimeter", "{:.2%}"),
    "stiffness_MPa_per_mm": (
        "tangent stiffness of the interface and its scatter, MPa/mm",
        "{:.3g}",
    ),
    "delta_sigma": ("Delta_sigma by box counting", "{:.2f}"),
}


def specimen_of(study: Mapping, source: str, name: str) -> tuple[xr.Dataset, Settings]:
    """A specimen of a study, synthetic or scanned, and its settings.

    Raises
    ------
    InputError
        If the study has none of this name, or its scan cannot be read.
    """
    if name in study.get("embedded", {}):
        recipe = resolve_embedded(study["embedded"][name], f"{source}: embedded.{name}")
        settings = resolve_settings(study, name, {}, source)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"{name}.npy"
            write_scan(path, embedded_surface(recipe), recipe["spacing"], sidecar={})
            options = sidecar_of_matrix(recipe["spacing"])
            return prepare_specimen(path, None, options, settings, name), settings
    scans, refused = list_scans(study["scans"]) if study.get("scans") else ({}, {})
    if name not in scans:
        raise InputError(str(refused.get(name, f"{source}: no specimen {name}, embedded or scan")))
    options, own = read_sidecar(scans[name].sidecar)
    scan = scans[name]
    settings = resolve_settings(study, name, own, source, scan)
    return prepare_specimen(scan.lower, scan.upper, options, settings, name), settings


def rows_of(
    specimen: xr.Dataset, settings: Settings, solver: Solver, pressures: Sequence[float]
) -> Iterator[dict]:
    """One row a model, grid and load; the first pressure is the seat.

    Raises
    ------
    InputError
        If the material states no joint wall strength.
    """
    name, material = specimen.attrs["name"], settings.material
    strength = material.joint_wall_strength
    if not strength or not np.isfinite(strength):
        raise InputError(
            f"{name}: its material states no joint_wall_strength; write one, such as "
            "'joint_wall_strength: 100 MPa'"
        )
    joint = describe_joint(specimen, settings)
    direction = settings.contact_directions[0]
    loading = JointLoading.of_joint(specimen, joint, direction, settings, solver).at_map_offset()
    heights = loading.composite(int(loading.cells[0]))
    for model, of_strength in MODELS.items():
        hardness = of_strength * strength
        carried = [pressure for pressure in pressures if pressure < hardness]
        solving = {"hardness": hardness, "rtol": solver.rtol}
        for factor in GRIDS:
            grid = subgrid(heights, 2) if factor < 1 else prefractal(heights, int(factor))
            space = loading.half_space(grid.shape, factor)
            forces = np.array(carried) * space.cell_area * grid.size
            seat = np.nan
            for pressure, state in zip(
                carried, load_steps(grid, space, forces, solving, name), strict=True
            ):
                numbers = state_quantities(state, float(grid.max()))
                side = float(np.sqrt(space.cell_area))
                domain = dimension_of_domain(state.in_contact, side, fit_range=settings.box_range)
                seat = numbers["closure"] if pressure == pressures[0] else seat
                yield {
                    "specimen": name,
                    "offset_mm": float(loading.offsets[0]),
                    "spacing_mm": side,
                    "model": model,
                    "grid": GRIDS[factor],
                    "pressure_MPa": pressure,
                    "nodes": int(np.count_nonzero(state.in_contact)),
                    "closure_mm": numbers["closure"] - seat,
                    "area": np.count_nonzero(state.in_contact) / grid.size,
                    "area_corrected": numbers["area_corrected"] / (space.cell_area * grid.size),
                    "stiffness_MPa_per_mm": numbers["stiffness"],
                    "stiffness_scatter": scatter_of(state, numbers["stiffness"]),
                    "delta_sigma": domain.dimension,
                }


def scatter_of(state: ContactState, stiffness: float) -> float:
    """Scatter of the stiffness of the interface over the cells that come to yield, MPa/mm."""
    area = float(np.prod(np.multiply(state.space.shape, state.space.spacing)))
    return state.slope.scatter / area * (stiffness * area / state.stiffness) ** 2


def written(table: pd.DataFrame, pressure: float) -> str:
    """The table of the page, from the file.

    Parameters
    ----------
    table : pd.DataFrame
        All rows of the file.
    pressure : float
        MPa, one of the file's.
    """
    at = table[np.isclose(table["pressure_MPa"], pressure)]
    lines = []
    for column, (heading, form) in SHOWN.items():
        lines += [f"Under {pressure:g} MPa, {heading}:", ""]
        lines += [
            "| specimen | model | s/2 | s | 2s | 4s | from 2s to s |",
            "|---|---|" + 5 * "---:|",
        ]
        for (specimen, model), group in at.groupby(["specimen", "model"], sort=False):
            values = group.set_index("grid")[column].reindex(list(GRIDS.values()))
            cells = [form.format(value) if np.isfinite(value) else "" for value in values]
            if column == "stiffness_MPa_per_mm":
                scatter = group.set_index("grid")["stiffness_scatter"].reindex(values.index)
                cells = [
                    f"{cell} ± {error:.2g}" if error > 0 else cell
                    for cell, error in zip(cells, scatter, strict=True)
                ]
            change = values["s"] / values["2s"] - 1
            cells.append(f"{change:+.1%}" if np.isfinite(change) else "")
            lines.append(f"| {specimen} | {model} | {' | '.join(cells)} |")
        lines.append("")
    return "\n".join(lines)


def main(arguments: Sequence[str]) -> None:
    """Solve the specimens, keep their rows and write the table of the page."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--study", type=Path, default=ROOT / "config/paper.yaml")
    default = ["sandstone_twin", "concrete_twin", "joint_2.3"]
    parser.add_argument("--specimens", nargs="+", default=default)
    parser.add_argument("--pressure", type=float, default=25.0, help="of the page, MPa")
    parser.add_argument("--table", type=Path, default=TABLE)
    parser.add_argument("--page", type=Path, default=PAGE)
    options = parser.parse_args(arguments)
    if options.pressure not in PRESSURES[1:]:
        parser.error(f"--pressure {options.pressure:g}: expected one of {PRESSURES[1:]}")
    try:
        study = read_study(options.study)
        solver = solver_settings(study, str(options.study))
        parts = [pd.read_csv(options.table)] if options.table.exists() else []
        for name in options.specimens:
            specimen, settings = specimen_of(study, str(options.study), name)
            found = pd.DataFrame(rows_of(specimen, settings, solver, PRESSURES))
            parts = [part[part["specimen"] != name] for part in parts] + [found]
    except InputError as error:
        sys.exit(str(error))
    table = pd.concat(parts, ignore_index=True)
    table.to_csv(options.table, index=False, float_format="%.6g")
    text = options.page.read_text(encoding="utf-8")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    page = f"{before}{BEGIN}\n\n{written(table, options.pressure)}{END}{after}"
    options.page.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
