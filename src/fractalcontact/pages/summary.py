"""Summary of a study: one row for each specimen and pressure."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from ..core.determined import decided_by_scan
from ..core.estimate import DIMENSION, Estimate, Judged, names_of
from ..core.measured_maps import map_table
from ..core.quantities import Shown, Value, shown_in
from ..core.subject import Subject
from ..core.validity import Validity
from ..core.verdicts import NO_PRESSURE, TOO_FEW_RESOLUTIONS, TOO_WIDE
from ..core.window import spacing_of, window_sides
from .common_loads import CommonLoad
from .laboratory import Test, calibration_of, tests_of
from .lights import Light, lights_of, validity_at
from .words import percent, plus_minus, with_unit

#: Errors of a quantity as a property of this surface, and of that which the window is cut from.
TOTALS = {"surface": "total", "population": "total_of_population"}
#: Columns of the stiffness at a pressure, by what stands in them.
_OF_STIFFNESS = ("", *(f"error_{of}_" for of in TOTALS), "hardest_")
#: Columns of the summary that are not called as the error budget calls their quantity.
_COLUMNS = {"closure": "interface_closure"}


def why(found: Estimate) -> str:
    """Reason why an estimate is missing or undetermined, or a remark on it."""
    if found.reason or found.determined or not found.known:
        return str(found.reason)
    return TOO_WIDE if np.isfinite(found.low) else "its error is not known"


@dataclass(frozen=True)
class Quantity:
    """A quantity of the error budget under one load.

    Attributes
    ----------
    name : str
        As the budget has it.
    meaning, unit : str
    absolute : bool
        Whether its errors are stated in the unit alone, never as fractions of the value.
    value : float
    errors : dict of str to float
        Half-widths at 95 %, in the unit: for this surface, for the whole joint.
    sources : dict of str to float
        By source.
    missing : str
        Why there is no value, where that is known.
    within : str
        Where the scan lies among its twins; empty without any.
    hardest : float
        Value if contacts are three times as hard, the other end of its range over hardness; NaN
        where they are elastic.
    """

    name: str
    meaning: str
    unit: str
    absolute: bool
    value: float
    errors: dict[str, float]
    sources: dict[str, float]
    missing: str = ""
    within: str = ""
    hardest: float = math.nan

    @property
    def known(self) -> bool:
        """True if there is a value."""
        return math.isfinite(self.value)

    def error_words(self, error: float) -> str:
        """An error in per cent of the value where the quantity has fractions, else in its unit."""
        return plus_minus(error, self._size_of(error))

    def _size_of(self, error: float) -> str:
        if self.absolute or not self.known or self.value == 0:
            return with_unit(error, self.unit, 2)
        return percent(abs(error / self.value))


@dataclass(frozen=True)
class AtLoad:
    """Quoted numbers of a specimen under one load.

    Attributes
    ----------
    number : int
        Of the load among those of the study.
    shown : dict of str to Value
        Of the quantities of ``core/quantities.yaml`` that tables show, by "STAGE/VARIABLE".
    model : Validity
        Whether the elastic model is valid, with the real mean pressure.
    """

    number: int
    normal_force: float
    nominal_pressure: float
    of_maps: bool
    shown: dict[str, Value]
    model: Validity
    quantities: dict[str, Quantity]
    dimensions: dict[str, Estimate]

    @property
    def real_pressure(self) -> float:
        """Real mean pressure F / A_r, MPa; NaN where too few nodes touch."""
        return self.model.pressure

    @property
    def no_real_pressure(self) -> str:
        """Reason for a missing real mean pressure; empty if there is one."""
        return "" if math.isfinite(self.real_pressure) else NO_PRESSURE

    @property
    def delta_sigma_boxes(self) -> Estimate:
        """Delta_sigma by box counting."""
        return self.dimensions["domains/delta_sigma"]

    @property
    def delta_sigma_areas(self) -> Estimate:
        """Delta_sigma by the area over resolutions."""
        return self.dimensions["scaling/delta_sigma_area"]

    def quoted(self, one: Shown) -> Quantity | Estimate:
        """A quantity of ``core/quantities.yaml`` with all that a cell of a table says of it."""
        if one.dimension:
            return self.dimensions[one.key]
        return self.quantities[one.budget] if one.budget else self.shown[one.key].estimate

    @property
    def suspect_share(self) -> float:
        """Fraction of the load on suspicious cells of the scans."""
        return self.shown["closure/suspect_load_share"].estimate.value

    @property
    def columns(self) -> dict[str, float]:
        """Columns of the summary, with the ends of intervals."""
        found: dict[str, float] = {}
        for one in shown_in("summary"):
            found |= self.shown[one.key].columns(one.summary)
        return found

    @property
    def rows(self) -> list[tuple[str, Value]]:
        """Rows of the specimen's page: title and value."""
        return [(one.page, self.shown[one.key]) for one in shown_in("page")]

    @property
    def decided_by_scan(self) -> bool:
        """True if suspicious cells of the scans carry most of the load: its numbers are theirs."""
        return bool(decided_by_scan(self.suspect_share))


@dataclass(frozen=True)
class Dilatancy:
    """Rigid dilatancy over the second half of the offsets.

    Attributes
    ----------
    kind : str
        "level", "rising", "falling"; "none" of what does not slide.
    level : float
        Its mean, mm.
    slope : float
        mm/mm.
    undecided : str
        Why its trend says nothing of a plateau; empty where it does.
    """

    kind: str
    level: float = math.nan
    slope: float = math.nan
    undecided: str = ""


@dataclass(frozen=True)
class Specimen:
    """One row of the table of specimens: lengths in mm."""

    name: str
    label: str
    opposite: str
    material: Mapping[str, Any]
    direction: str
    offset: float
    window: tuple[float, float]
    spacing: float
    delta_g: Estimate
    estimator: str
    rms_slope: float
    k_ni: Estimate
    v_m: Estimate
    chi: Estimate
    seat: float
    stiffness: dict[float, tuple[float, ...]]
    hardest: float
    changes: dict[str, float]
    closure_law: str
    dilatancy: Dilatancy
    loads: list[AtLoad]
    lights: list[Light]
    tests: list[Test]
    calibration: tuple[str, Estimate, str]

    @property
    def of_maps(self) -> AtLoad:
        """State under the reference load."""
        return next(load for load in self.loads if load.of_maps)

    def at(self, number: int | None) -> AtLoad | None:
        """Quoted numbers under the load of this number."""
        return next((load for load in self.loads if load.number == number), None)


def summarised(subject: Subject, common: Sequence[CommonLoad] = ()) -> Specimen:
    """The row of a specimen.

    Parameters
    ----------
    subject : Subject
    common : sequence of CommonLoad, optional
        Loads at which it is compared with others: quoted too.
    """
    compared = {load.numbers[subject.name] for load in common if subject.name in load.numbers}
    specimen = subject["specimens"]
    side_y, side_x = window_sides(specimen)
    surface = subject["surface_dimension"]
    curve = subject.states("closure")
    why_none = str(surface["no_dimension"].item())
    return Specimen(
        name=subject.name,
        label=subject.label,
        opposite=str(specimen.attrs["opposite"]),
        material=subject.settings["material"],
        direction=subject.direction,
        offset=subject.offset,
        window=(side_x, side_y),
        spacing=max(spacing_of(specimen)),
        delta_g=Estimate.read(surface, "recommended_dimension", reason=why_none, scale=DIMENSION),
        estimator=str(surface["recommended"].item()).replace("_", " "),
        rms_slope=float(subject.states("area")["rms_slope"]),
        k_ni=_initial_stiffness(curve),
        v_m=Estimate.read(curve, "seated_v_m"),
        chi=Estimate.read(curve, "seated_chi"),
        seat=float(curve["seating_pressure"]),
        stiffness=_stated_stiffness(subject),
        hardest=float(subject["error_budget"]["hardest_hardness"]),
        changes={
            name: float(subject.state("closure")[f"{of}_change"])
            for name, of in (("k_ni", "seated_k_ni"), ("stiffness", "interface_stiffness"))
        },
        closure_law=str(curve["closure_law"].item()),
        dilatancy=dilatancy_of(subject),
        loads=[
            _at_load(subject, curve, i) for i in sorted(compared.union(subject.reported.quoted))
        ],
        lights=lights_of(subject),
        tests=tests_of(subject),
        calibration=calibration_of(subject),
    )


def _initial_stiffness(curve):
    """k_ni of the seated hyperbola: undetermined, with the reason, where the atlas says so."""
    says, reason = (curve[f"seated_k_ni_{name}"].item() for name in ("determined", "reason"))
    found = Estimate.read(curve, "seated_k_ni")
    return Judged(*found.ends, reason=reason, says=bool(says))


def _stated_stiffness(subject):
    """Tangent stiffness, its two errors, and it of harder contacts, by nominal pressure.

    MPa/mm; NaN if unknown.
    """
    stated = subject.states("closure")["reference_stiffness"]
    budget = subject["error_budget"]
    beside = [budget[f"reference_stiffness_{of}"] for of in (*TOTALS.values(), "hardest")]
    numbers = zip(*(one.values.tolist() for one in (stated, *beside)), strict=True)
    return dict(zip(stated["reference_pressure"].values.tolist(), numbers, strict=True))


def _at_load(subject, curve, number):
    """Numbers of the table under the load of this number."""
    state = {"normal_force": number}
    return AtLoad(
        number=number,
        normal_force=float(subject.forces[number]),
        nominal_pressure=float(curve["nominal_pressure"][number]),
        of_maps=number == subject.reported.reference,
        shown={one.key: one.at(subject, number) for one in shown_in("summary", "page", "index")},
        model=validity_at(subject, number),
        quantities=quantities_at(subject, number),
        dimensions={
            "domains/delta_sigma": _dimension(subject, "domains", state),
            "scaling/delta_sigma_area": _dimension(subject, "scaling", state),
        },
    )


def _dimension(subject, stage, state):
    """Delta_sigma of a stage, with the stage's reason where it is missing."""
    states = subject.states(stage)
    read = (*names_of("delta_sigma"), "reason")
    found = states[[name for name in read if name in states]].isel(state)
    note = str(found["reason"].item()) if "reason" in found else ""
    if not note and np.isnan(float(found["delta_sigma"])):
        note = TOO_FEW_RESOLUTIONS
    return Estimate.read(found, "delta_sigma", reason=note, scale=DIMENSION)


def quantities_at(subject: Subject, number: int) -> dict[str, Quantity]:
    """Quantities of the error budget under the load of this number.

    Parameters
    ----------
    subject : Subject
    number : int
        Among the loads of the study.
    """
    budget = subject["error_budget"]
    force = subject.forces[number]
    budget = budget.sel(normal_force=force, method="nearest")
    sources = [str(source) for source in budget["source"].values]
    why = subject.states("closure")["interface_stiffness_reason"].isel(normal_force=number)
    missing = {"stiffness": str(why.item())}
    found = {"seated_closure": _seated_closure(subject, number, budget)}
    for name in map(str, budget["quantity"].values):
        one = budget.sel(quantity=name)
        found[name] = Quantity(
            name=name,
            meaning=str(one["meaning"].item()),
            unit=str(one["unit"].item()),
            absolute=bool(one["absolute"]),
            value=float(one["published"]),
            errors={which: float(one[total]) for which, total in TOTALS.items()},
            sources=dict(zip(sources, map(float, one["error"].values), strict=True)),
            missing=missing.get(name, ""),
            within=str(one["within_twins"].item()) if "within_twins" in one else "",
            hardest=float(one["hardest"]),
        )
    return found


def _seated_closure(subject, number, budget):
    """Closure from the seat, of which the budget has the totals and no sources."""
    value = float(subject.states("closure")["seated_closure"].isel(normal_force=number))
    errors = {which: float(budget[f"seated_closure_{total}"]) for which, total in TOTALS.items()}
    missing = "" if math.isfinite(value) else "below the seat, or not solved"
    if value == 0:
        missing = "the seat, from which closure is counted"
    name, meaning = "seated_closure", "closure from the seat"
    hardest = float(budget["seated_closure_hardest"])
    return Quantity(name, meaning, "mm", False, value, errors, {}, missing, "", hardest)


def dilatancy_of(subject: Subject) -> Dilatancy:
    """Level and slope of the rigid dilatancy over the second half of the offsets."""
    joints = subject["joints"]
    if subject.direction not in joints["direction"]:
        return Dilatancy("none")
    along = joints.sel(direction=subject.direction)
    kind = str(along["plateau_trend"].item())
    level, slope = (float(along[f"plateau_{name}"]) for name in ("level", "slope"))
    undecided = str(along["plateau_undecided"].item()) if kind else ""
    return Dilatancy(kind or "none", level, slope, undecided)


def summary_table(
    study: str, specimens: Sequence[Specimen], maps: Mapping[str, xr.Dataset]
) -> pd.DataFrame:
    """The summary as a table; units end the names of its columns.

    One row a specimen and pressure; of a study of measured contact maps alone, one row a map.

    Parameters
    ----------
    study : str
    specimens : sequence of Specimen
    maps : mapping of str to xr.Dataset
        Measured contact maps by name.
    """
    if maps and not specimens:
        table = map_table(maps)
        return table.assign(study=study).set_index("study").reset_index()
    rows = []
    for one in specimens:
        start = {"study": study} | _of_specimen(one)
        rows += [start | _of_load(load) for load in one.loads]
    return pd.DataFrame(rows) if rows else pd.DataFrame(columns=["study", "specimen"])


def _of_specimen(one):
    row = {
        "specimen": one.name,
        "label": one.label,
        "opposite": one.opposite,
        "material": one.material["name"],
        "modulus_MPa": float(one.material["modulus"]),
        "poisson": float(one.material["poisson"]),
        "hardness_MPa": float(one.material["hardness"]),
        "hardest_hardness_MPa": one.hardest,
        "direction": one.direction,
        "offset_mm": one.offset,
        "window_x_mm": one.window[0],
        "window_y_mm": one.window[1],
        "spacing_mm": one.spacing,
        **_columns("delta_g", one.delta_g),
        "delta_g_estimator": one.estimator,
        "rms_slope": one.rms_slope,
        "seating_pressure_MPa": one.seat,
        **{
            f"stiffness_at_{pressure:g}_MPa_{of}MPa_per_mm": number
            for pressure, numbers in one.stiffness.items()
            for of, number in zip(_OF_STIFFNESS, numbers, strict=True)
        },
        **_columns("k_ni_MPa_per_mm", one.k_ni),
        **_columns("v_m_mm", one.v_m),
        **_columns("chi_mm", one.chi),
        "k_ni_reason": why(one.k_ni),
        **{f"{of}_change_at_twice_the_spacing": part for of, part in one.changes.items()},
        "closure_law": one.closure_law,
        "dilatancy": one.dilatancy.kind,
        "dilatancy_undecided": one.dilatancy.undecided,
        "dilatancy_level_mm": one.dilatancy.level,
        "dilatancy_slope": one.dilatancy.slope,
    }
    lights = {f"light_{light.key}": light.word for light in one.lights}
    row |= {name: value for test in one.tests for name, value in test.columns.items()}
    return row | lights | {f"help_{light.key}": light.help for light in one.lights}


def _of_load(load):
    row = {
        "normal_force_N": load.normal_force,
        "nominal_pressure_MPa": load.nominal_pressure,
        "load_of_maps": load.of_maps,
        **load.columns,
        "real_pressure_MPa": load.real_pressure,
        "real_pressure_reason": load.no_real_pressure,
        "elastic_model": load.model.verdict,
        "elastic_model_good_to_MPa": load.model.limits.good_to,
        "elastic_model_poor_from_MPa": load.model.limits.poor_from,
    }
    for name, quantity in load.quantities.items():
        if name == "delta_sigma":  # stands below, with its interval
            continue
        name = _COLUMNS.get(name, name)
        unit = quantity.unit.replace("/", "_per_")
        row[f"{name}_{unit}"] = quantity.value
        row |= {f"{name}_error_{which}_{unit}": error for which, error in quantity.errors.items()}
        row[f"{name}_hardest_{unit}"] = quantity.hardest
        if name == "stiffness":
            row["stiffness_reason"] = quantity.missing
    row |= _columns("delta_sigma_boxes", load.delta_sigma_boxes)
    return row | _columns("delta_sigma_areas", load.delta_sigma_areas)


def _columns(name, found):
    return {
        name: found.value,
        f"{name}_low": found.low,
        f"{name}_high": found.high,
        f"{name}_determined": found.determined,
    }
