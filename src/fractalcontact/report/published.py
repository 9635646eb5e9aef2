"""Register of published numbers, ``published.yaml``, and its one reader."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
import yaml

from ..core.determined import decided_by_scan
from ..core.estimate import DIMENSION, IN_PLANE, SIZE, Estimate, names_of
from ..core.limits import JRC_SAMPLING
from ..core.settings import TEST_COLUMNS
from ..core.subject import Subject
from ..core.verdicts import TOO_WIDE
from .needs import NEEDS

_FILE = Path(__file__).with_suffix(".yaml")
#: Label of each number of a curve by its dimension: name, coordinate, unit.
_BESIDE = {
    "normal_force": ("pressure", "nominal_pressure", "MPa"),
    "reference_pressure": ("pressure", "reference_pressure", "MPa"),
    "interval": ("offset", "interval", "mm"),
    "offset": ("offset", "offset", "mm"),
    "contact_direction": ("direction", "contact_direction", "1"),
    "sampling": ("sampling", "sampling", "1"),
    "fit": ("fit", "fit", "1"),
    "branch": ("branch", "branch", "1"),
    "face_direction": ("direction", "face_direction", "1"),
    "block_length": ("length", "block_length", "mm"),
    "rule": ("rule", "rule", "1"),
    **{f"{kind}_test": ("test", f"{kind}_test", "1") for kind in TEST_COLUMNS},
}
#: Units of the labels of a number.
UNITS_AT = {name: unit for name, _, unit in _BESIDE.values()} | {"step": "mm", "fit_step": "mm"}
_NOT_SOLVED = "not solved under this load"
#: Reason why a number with a narrow interval is undetermined.
BY_SCAN = "suspicious cells of the scan carry most of the force"
#: Reason why a number is undetermined whose error passes the largest that its row allows.
TOO_UNCERTAIN = "its error is larger than half of it"
#: Reason of what counts from first touch.
BY_TOUCH = "first touch lies on suspicious cells of the scan"


class Number(NamedTuple):
    """Published number, unrounded.

    Attributes
    ----------
    at : dict
        Pressure, offset, direction and the like; empty for a single number.
    estimate : Estimate
        Value of the atlas with its interval; ``reason`` is a remark on it.
    missing : str
        Why it is no result; empty of a result.
    determined : bool
        False where the interval of a fit or dimension, its stage, or the scan says so.
    error, population : float
        Half-widths at 95 % for this surface and for the whole joint; NaN where not known.
    hardest : float
        Value if contacts are three times as hard; NaN where they are elastic.
    """

    at: dict[str, Any]
    estimate: Estimate
    missing: str = ""
    determined: bool = True
    error: float = math.nan
    population: float = math.nan
    hardest: float = math.nan

    @property
    def value(self) -> float:
        """Value as the atlas has it, unrounded."""
        return float(self.estimate.value)

    @property
    def remark(self) -> str:
        """Reason why it is missing or undetermined, or a remark on it."""
        if self.missing or self.estimate.reason or self.determined:
            return self.missing or str(self.estimate.reason)
        if self.estimate.determined:
            return BY_SCAN
        return TOO_WIDE if math.isfinite(self.estimate.low) else "its error is not known"


@dataclass(frozen=True)
class Row:
    """Quantity of the register; ``published.yaml`` explains the keys. ``source`` is ``from``."""

    name: str
    title: str
    source: str
    unit: str
    of: Mapping[str, str] = field(default_factory=dict)
    all: bool = False
    budget: str = ""
    hardest: str = ""
    error: str = ""
    most: float = math.nan
    within: tuple[float, float] = (0.0, math.inf)
    dimension: bool = False
    range: tuple[str, ...] = ()
    flag: str = ""
    misfit: str = ""
    note: str = ""
    reason: str = ""
    zero: str = ""
    beside: tuple[str, ...] = ()
    by_scan: bool = False
    from_touch: bool = False
    needs: tuple[str, ...] = ()
    absent: str = ""
    missing: str = "the study does not state it"
    section: str = ""
    model: str = "stated"
    law: str = ""
    interval: str = ""
    head: str = ""
    errors: bool = False
    print: bool = True
    summary: str = ""
    why: bool = False
    curves: str = ""
    explorer: bool = False
    page: str = ""
    index: str = ""
    extra: bool = False
    shown: str = ""

    @property
    def stage(self) -> str:
        """Stage of the atlas that holds the variable."""
        return self.source.partition("/")[0]

    @property
    def variable(self) -> str:
        """Name in that stage."""
        return self.source.partition("/")[2]

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest value that it can have."""
        least, most = IN_PLANE if self.dimension else self.within
        return least, most

    @property
    def uncertain(self) -> bool:
        """True if the quantity has an interval, where that is known."""
        return bool(self.budget or self.error or self.interval or self.range or self.dimension)

    @property
    def signed(self) -> bool:
        """True if the quantity may be zero or of either sign: its errors are no fractions of it."""
        return self.dimension or self.within[0] < 0


#: Where a number may be shown, by the key of its row that says so.
PLACES = {
    "section": "card",
    "summary": "`summary.csv`",
    "curves": "`curves.csv`",
    "explorer": "explorer",
    "page": "page",
    "index": "index",
    "shown": "atlas alone",
}


@cache
def published() -> tuple[Row, ...]:
    """All quantities, in their order."""
    stated = yaml.safe_load(_FILE.read_text(encoding="utf-8"))
    renamed = {"from": "source", "with": "beside"}
    return tuple(
        Row(name, **{renamed.get(key, key): value for key, value in keys.items()})
        for name, keys in stated.items()
    )


def shown_in(*places: str) -> tuple[Row, ...]:
    """Quantities shown in any of some places, such as "summary", "page" or "section" of a card."""
    return tuple(row for row in published() if any(getattr(row, place) for place in places))


def stages_of(*places: str) -> set[str]:
    """Stages that the numbers of some places are read from, with those of the reported state."""
    sources = [
        source
        for row in shown_in(*places)
        for source in (row.source, row.error, row.flag, row.reason, row.misfit, *row.range)
    ]
    stages = {source.partition("/")[0] for source in sources} - {"", "settings"}
    return stages | {"specimens", "closure", "error_budget"}


@cache
def row_of(name: str) -> Row:
    """Row of the register by the name of its quantity."""
    return next(row for row in published() if row.name == name)


# -- the reader ------------------------------------------------------------------------------------


def read(row: Row, subject: Subject) -> list[Number]:
    """Numbers of a quantity of a specimen at its reported state.

    There is a number for each value of the dimensions that are left, in C order; a single number
    without ``at`` where the specimen lacks the quantity.
    """
    for need in row.needs:
        if why := NEEDS[need](subject):
            return [Number({}, Estimate(), why)]
    if row.stage == "settings":
        stated = subject.settings["material"].get(row.variable)
        # Settings have an infinite hardness where nothing bounds the pressure.
        value = float(stated) if stated is not None and math.isfinite(stated) else math.nan
        why = "" if math.isfinite(value) else row.missing
        # How the study knows a constant, such as an assumed friction angle.
        source = str(subject.settings["material"].get(f"{row.variable}_is", ""))
        return [Number({}, Estimate(value, reason="" if why else source), why)]
    array = array_of(row, subject, row.source)
    if array is None:
        return [Number({}, Estimate(), row.absent or row.missing)]
    return list(_numbers(row, subject, array))


def is_of_law(at: Mapping[str, Any], direction: str) -> bool:
    """True of the labels of the JRC that Barton's law takes: its step, along a direction."""
    return bool(at["sampling"] == JRC_SAMPLING and at["direction"] == direction)


def read_at(row: Row, subject: Subject, load: int | None = None) -> Number:
    """Number of a quantity under a load; the first of a quantity that is not over all loads."""
    number = subject.reported.reference if load is None else load
    return under_load(read(row, subject), number, subject.forces.size)


def under_load(numbers: list[Number], load: int, loads: int) -> Number:
    """Number of a quantity under a load; the only number of one that is not over all loads."""
    return numbers[load if len(numbers) == loads and "pressure" in numbers[0].at else 0]


def array_of(row: Row, subject: Subject, source: str) -> xr.DataArray | None:
    """Variable "STAGE/VARIABLE" at the state of a row; None if the atlas lacks it.

    Branches leave out the loads far above the seating pressure, and have no value there.
    """
    stage, _, variable = source.partition("/")
    if stage not in subject.stages or variable not in subject[stage]:
        return None
    states = subject[stage] if row.all else subject.states(stage)
    array = states[variable].sel({k: v for k, v in row.of.items() if k in states[variable].dims})
    if stage == "branches" and "normal_force" in array.dims:
        missing = "" if array.dtype.kind == "U" else math.nan
        array = array.reindex(normal_force=subject.forces, fill_value=missing)
    return array


def fitted_over(row: Row, subject: Subject) -> tuple[float, float, str] | None:
    """Ends of the range of a fit, and their unit; None of what is no fit."""
    ends = [array_of(row, subject, source) for source in row.range]
    if not ends or ends[0] is None or ends[1] is None:
        return None
    return ends[0].item(), ends[1].item(), str(ends[0].attrs["units"])


def total_of(row: Row, subject: Subject, kind: str = "total") -> xr.DataArray | None:
    """Errors of a quantity over the loads or reference pressures, as the error budget has them.

    ``kind`` is "total", "total_of_population" or "hardest": the last are its values for harder
    contacts. None without a budget.
    """
    budget = subject.stages.get("error_budget")
    if budget is None or not row.budget:
        return None
    if (own := f"{row.budget}_{kind}") in budget:
        return budget[own]
    if row.budget not in budget["quantity"]:
        return None
    return budget[kind].sel(quantity=row.budget, drop=True)


def _numbers(row: Row, subject: Subject, array: xr.DataArray) -> Iterator[Number]:
    def over(other: xr.DataArray | None, otherwise: Any) -> np.ndarray:
        """Values of an array over the places of the quantity."""
        if other is None:
            return np.full(array.shape, otherwise)
        size = [n if dim in other.dims else 1 for dim, n in array.sizes.items()]
        ordered = other.transpose(*(dim for dim in array.dims if dim in other.dims))
        return np.broadcast_to(ordered.values.reshape(size), array.shape)

    def named(source: str, otherwise: Any = math.nan) -> np.ndarray:
        return over(array_of(row, subject, source), otherwise)

    flags, reasons = named(row.flag, 1.0), named(row.reason, "")
    error, population, hardest = (
        over(total_of(row, subject, kind), math.nan)
        for kind in ("total", "total_of_population", "hardest")
    )
    if row.error:
        error = named(row.error)
    if row.hardest:
        hardest = named(row.hardest)
    ends = _ends(row, subject, array, error)
    solved = named("closure/solved" if array.dims == ("normal_force",) else "", True)
    share = named("closure/suspect_load_share" if row.by_scan else "")
    by_scan = decided_by_scan(share)
    at_touch = row.from_touch and _lightest_by_scan(share, value_known=np.isfinite(array.values))
    related = {_BESIDE[str(dim)][0]: named(_beside(row, dim)) for dim in array.dims}
    related |= {name: named(f"{row.stage}/{name}") for name in row.beside}
    for place in np.ndindex(array.shape):
        why, valid = str(reasons[place]), bool(np.nan_to_num(flags[place]))
        if at_touch and not by_scan[place]:
            why = why or BY_TOUCH
        value, low, high = (end[place] for end in ends)
        too_uncertain = bool(error[place] > row.most * abs(value))
        if too_uncertain and valid and not by_scan[place]:
            why = why or TOO_UNCERTAIN
        scale = DIMENSION if row.dimension else SIZE
        estimate = Estimate(value, low, high, reason=why, scale=scale)
        missing = _missing(row, estimate, valid, why)
        determined = not (by_scan[place] or at_touch or too_uncertain)
        if row.range or row.dimension:
            determined &= bool(estimate.known and valid and estimate.determined)
        yield Number(
            {name: _plain(values[place]) for name, values in related.items()},
            estimate,
            missing if solved[place] or not missing else _NOT_SOLVED,
            determined,
            *(float(numbers[place]) for numbers in (error, population, hardest)),
        )


def _lightest_by_scan(share: np.ndarray, value_known: np.ndarray) -> bool:
    """True if suspicious cells carry most of the lightest load with a value; over the loads."""
    known = np.flatnonzero(value_known)
    return bool(known.size and decided_by_scan(share[known[0]]))


def _missing(row: Row, estimate: Estimate, valid: bool, why: str) -> str:
    """Reason why a number is no result; a fit that is not valid is undetermined instead."""
    if not valid and not row.range:
        return why or (row.note if estimate.known else "") or row.missing
    return "" if estimate.known else why or row.missing


def _ends(row, subject, array, error):
    """Value with lower and upper end, of its own interval or from its error."""
    value = np.asarray(array.values, float)
    names = names_of(row.variable)[1:]
    low, high = (array_of(row, subject, f"{row.stage}/{name}") for name in names)
    if low is not None and high is not None:
        return value, low.values, high.values
    if not (row.budget or row.error):
        error = np.full(value.shape, math.nan)
    return Estimate.about(value, error, *row.bounds).ends


def _beside(row, dim):
    return f"{row.stage}/{_BESIDE[str(dim)][1]}"


def _plain(label: Any) -> Any:
    """Label without numpy's type."""
    return label.item() if isinstance(label, np.generic) else label
