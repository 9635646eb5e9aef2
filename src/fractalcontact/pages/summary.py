"""Summary of a study, one row for each specimen and pressure, and what its pages say of each."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import pandas as pd
import xarray as xr

from ..core.estimate import column_of
from ..core.measured_maps import map_table
from ..core.subject import Subject
from ..core.validity import Validity
from ..core.window import spacing_of, window_sides
from ..report.columns import columns_of, old_columns_of
from ..report.published import Number, read, shown_in, under_load
from .common_loads import CommonLoad
from .lights import Light, lights_of, validity_at

#: Rules for the peak shear strength, by their rows, in words.
STRENGTH_RULES = {
    "peak_strength": "dilatancy",
    "contact_strength": "contact",
    "barton_strength": "Barton",
    "barton_scaled_strength": "Barton and Bandis",
}


@dataclass(frozen=True)
class Sheet:
    """Published numbers of a specimen by their names in the register, with what stands beside them.

    ``words`` and ``lengths`` (mm) are those of the specimen. ``loads`` are the numbers of the
    quoted loads, ``forces`` (N) and ``pressures`` (MPa) those of all; ``models`` has the verdict on
    the elastic model under each quoted load.
    """

    words: dict[str, str]
    lengths: dict[str, float]
    numbers: dict[str, list[Number]]
    loads: list[int]
    reference: int
    forces: list[float]
    pressures: list[float]
    models: dict[int, Validity]
    lights: list[Light]

    def of(self, name: str, load: int | None = None) -> Number:
        """Number of a quantity under a load, by default the reference load."""
        number = self.reference if load is None else load
        return under_load(self.numbers[name], number, len(self.forces))


def lengths_of(subject: Subject) -> dict[str, float]:
    """Offset, sides of the window and spacing of a specimen, mm."""
    side_y, side_x = window_sides(subject["specimens"])
    spacing = max(spacing_of(subject["specimens"]))
    return {"offset": subject.offset, "window_x": side_x, "window_y": side_y, "spacing": spacing}


def sheet_of(subject: Subject, common: Sequence[CommonLoad] = ()) -> Sheet:
    """Published numbers of a specimen; loads at which it is compared with others are quoted too."""
    compared = {load.numbers[subject.name] for load in common if subject.name in load.numbers}
    loads = sorted(compared.union(subject.reported.quoted))
    specimen, states = subject["specimens"], subject.states("closure")
    return Sheet(
        words={
            "specimen": subject.name,
            "label": subject.label,
            "opposite": str(specimen.attrs["opposite"]),
            "material": subject.settings["material"]["name"],
            "direction": subject.direction,
            "delta_g_estimator": _words(subject["surface_dimension"]["recommended"], "_", " "),
            "closure_law": _words(states["closure_law"]),
            **_dilatancy(subject),
        },
        lengths=lengths_of(subject),
        numbers={row.name: read(row, subject) for row in shown_in("summary", "page", "index")},
        loads=loads,
        reference=subject.reported.reference,
        forces=states["normal_force"].values.tolist(),
        pressures=states["nominal_pressure"].values.tolist(),
        models={load: validity_at(subject, load) for load in loads},
        lights=lights_of(subject),
    )


def _words(variable, *replaced):
    return str(variable.item()).replace(*replaced) if replaced else str(variable.item())


def _dilatancy(subject):
    """Trend of the rigid dilatancy, and why it does not decide about a plateau."""
    joints, trend, undecided = subject["joints"], "", ""
    if subject.direction in joints["direction"]:
        along = subject.along("joints")
        trend = str(along["plateau_trend"].item())
        undecided = str(along["plateau_undecided"].item()) if trend else ""
    return {"dilatancy": trend or "none", "dilatancy_undecided": undecided}


# -- the table -------------------------------------------------------------------------------------


def summary_table(
    study: str, sheets: Sequence[Sheet], maps: Mapping[str, xr.Dataset]
) -> pd.DataFrame:
    """Summary as a table, one row a specimen and pressure; units end the names of its columns.

    A study of measured contact maps alone has one row a map.
    """
    if maps and not sheets:
        table = map_table(maps)
        return table.assign(study=study).set_index("study").reset_index()
    rows = [
        {"study": study} | _of_specimen(sheet) | _of_load(sheet, load)
        for sheet in sheets
        for load in sheet.loads
    ]
    return pd.DataFrame(rows) if rows else pd.DataFrame(columns=["study", "specimen"])


def _of_specimen(sheet):
    lengths = {column_of(name, "mm"): length for name, length in sheet.lengths.items()}
    lights = {f"light_{light.key}": light.word for light in sheet.lights}
    helps = {f"help_{light.key}": light.help for light in sheet.lights}
    return sheet.words | lengths | lights | helps


def _of_load(sheet, load):
    model = sheet.models[load]
    columns = {
        "normal_force_N": sheet.forces[load],
        "nominal_pressure_MPa": sheet.pressures[load],
        "load_of_maps": load == sheet.reference,
        "elastic_model": model.verdict,
    }
    numbers = [
        (row, number)
        for row in shown_in("summary")
        for number in _quoted(sheet, row, load)
        if number.at or "{" not in row.summary
    ]
    for row, number in numbers:
        columns |= columns_of(row, number)
    columns |= _strength_range(sheet, load)
    for row, number in numbers:
        columns |= old_columns_of(row, number)
    return columns


def _strength_range(sheet, load):
    """Least and largest shear strength over the rules that have one under a load, MPa."""
    numbers = [sheet.of(name, load) for name in STRENGTH_RULES]
    values = [number.value for number in numbers if not number.missing]
    ends = {"lowest": min(values, default=math.nan), "highest": max(values, default=math.nan)}
    return {column_of("strength", "MPa", of): value for of, value in ends.items()}


def _quoted(sheet, row, load):
    """Numbers of a quantity in the row of a load: one, or one a pressure or test."""
    return sheet.numbers[row.name] if "{" in row.summary else [sheet.of(row.name, load)]
