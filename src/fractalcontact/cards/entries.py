"""Entries of a card, read from the atlas by ``entries.yaml`` without any computation."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import yaml

from ..core.estimate import DIMENSION, SIZE, Estimate, names_of
from ..core.settings import TEST_COLUMNS
from ..core.subject import Subject
from ..core.text import OPPOSITE, percent

_FILE = Path(__file__).with_name("entries.yaml")
#: What stands for a dimension beside each row of a curve: its name there, its coordinate, its unit.
_BESIDE = {
    "normal_force": ("pressure", "nominal_pressure", "MPa"),
    "reference_pressure": ("pressure", "reference_pressure", "MPa"),
    "interval": ("offset", "interval", "mm"),
    "offset": ("offset", "offset", "mm"),
    "contact_direction": ("direction", "contact_direction", "1"),
    "sampling": ("sampling", "sampling", "1"),
    "fit": ("fit", "fit", "1"),
    "branch": ("branch", "branch", "1"),
    **{f"{kind}_test": ("test", f"{kind}_test", "1") for kind in TEST_COLUMNS},
}
#: Significant digits of the numbers of a card.
_DIGITS = 6
_NOT_SOLVED = "not solved under this load"


def _unstated(key: str, words: str) -> Callable[[Subject], str]:
    """Reason for what needs a number of the material; empty where it is stated."""

    def reason(subject: Subject) -> str:
        stated = subject.settings["material"].get(key)
        known = stated is not None and math.isfinite(stated)
        return "" if known else f"no {words} is stated"

    return reason


def _not_sliding(subject: Subject) -> str:
    """Reason for what needs faces that slide."""
    if "strength" in subject.stages:
        return ""
    return f"nothing slides: {OPPOSITE[subject['specimens'].attrs['opposite']]}"


def _no_jrc(subject: Subject) -> str:
    known = np.isfinite(subject.states("strength")["jrc_used"].item())
    return "" if known else "no JRC at the step of its law"


#: What an entry may need: the reason where it is absent, or nothing.
NEEDS: Mapping[str, Callable[[Subject], str]] = {
    "sliding": _not_sliding,
    "basic_friction_angle": _unstated("basic_friction_angle", "basic friction angle"),
    "joint_wall_strength": _unstated("joint_wall_strength", "joint wall strength"),
    "jrc": _no_jrc,
}


@dataclass(frozen=True)
class Entry:
    """A quantity of the card, as ``entries.yaml`` describes it.

    Attributes
    ----------
    key, section, title : str
    source : str
        "STAGE/VARIABLE"; empty of what no stage has.
    """

    key: str
    section: str
    title: str
    source: str = ""
    unit: str = ""
    of: Mapping[str, str] = field(default_factory=dict)
    all: bool = False
    error: str = ""
    population: str = ""
    hardest: str = ""
    within: tuple[float, float] = (0.0, math.inf)
    interval: str = ""
    range: tuple[str, ...] = ()
    flag: str = ""
    note: str = ""
    misfit: str = ""
    reason: str = ""
    beside: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    absent: str = ""
    model: str = "stated"
    law: str = ""
    dimension: bool = False
    missing: str = "the study does not state it"
    print: bool = True


@cache
def entries() -> tuple[Entry, ...]:
    """All entries, in their order."""
    stated = yaml.safe_load(_FILE.read_text(encoding="utf-8"))
    renamed = {"from": "source", "with": "beside"}
    return tuple(
        Entry(key, section, **{renamed.get(name, name): value for name, value in one.items()})
        for section, each in stated.items()
        for key, one in each.items()
    )


def read_entry(entry: Entry, subject: Subject, model: str) -> dict[str, Any]:
    """Entry of a card with its values.

    Parameters
    ----------
    entry : Entry
    subject : Subject
    model : str
        What the contact was solved as.

    Returns
    -------
    dict
        Of ``card.schema.json``: a number where no dimension is left, else a curve with ``values``.
    """
    found: dict[str, Any] = {"title": entry.title, "section": entry.section}
    without = next(filter(None, (NEEDS[one](subject) for one in entry.needs)), "")
    rows = [] if without else list(_rows(entry, subject))
    unit = entry.unit or (_units(entry, subject) if rows else "")
    found |= {"unit": unit or "1", "model": model if entry.model == "contact" else entry.model}
    if entry.law:
        found["law"] = entry.law
    if entry.interval:
        found["interval"] = entry.interval
    if over := _range(entry, subject):
        found["range"] = over
    if not entry.print:
        found["print"] = False
    if without:
        return found | {"missing": without}
    if not rows:
        return found | {"missing": entry.absent or entry.missing}
    if len(rows) == 1 and not rows[0][0]:
        return found | rows[0][1]
    units = {name: unit for name, _, unit in _BESIDE.values()} | {"step": "mm", "fit_step": "mm"}
    at = {name: units[name] for name in rows[0][0]}
    return found | {"at_units": at, "values": [{"at": at} | number for at, number in rows]}


def number(estimate: Estimate, missing: str) -> dict[str, Any]:
    """An estimate as the card writes it: value and ends, or why there is none.

    Parameters
    ----------
    estimate : Estimate
        Of a single number.
    missing : str
        Why there is no value, where the estimate gives no reason.
    """
    if not estimate.known:
        return {"missing": str(estimate.reason) or missing}
    return dict(zip(("value", "low", "high"), map(rounded, estimate.ends), strict=True))


def rounded(value: Any) -> float | None:
    """A number with the digits of a card; None where it is not finite."""
    return float(f"{float(value):.{_DIGITS}g}") if math.isfinite(value) else None


# -- one entry -------------------------------------------------------------------------------------


def _stage(entry: Entry, subject: Subject, key: str) -> tuple[xr.Dataset, str] | None:
    """Stage of a "STAGE/VARIABLE" at the reported state, and the variable; None without."""
    stage, _, variable = key.partition("/")
    if stage not in subject.stages or variable not in subject[stage]:
        return None
    states = subject[stage] if entry.all else subject.states(stage)
    of = {name: label for name, label in entry.of.items() if name in states.dims}
    return states.sel(of), variable


def _values(entry, subject, key):
    """Array of a "STAGE/VARIABLE"; None if the atlas lacks it."""
    found = _stage(entry, subject, key) if key else None
    return None if found is None else found[0][found[1]]


def _units(entry, subject):
    array = _values(entry, subject, entry.source)
    return "" if array is None else str(array.attrs["units"])


def _range(entry, subject):
    """Range of a fit, with its unit."""
    ends = [_values(entry, subject, key) for key in entry.range]
    if not ends or any(end is None for end in ends):
        return None
    low, high = (rounded(end.item()) for end in ends)
    return {"low": low, "high": high, "unit": str(ends[0].attrs["units"])}


def _rows(entry: Entry, subject: Subject) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Conditions of each number, and the number."""
    stage, _, variable = entry.source.partition("/")
    if stage == "settings":
        stated = subject.settings["material"].get(variable)
        value = math.nan if stated is None else float(stated)
        # No bound on the pressure is an infinite one.
        yield {}, number(Estimate(value if math.isfinite(value) else math.nan), entry.missing)
        return
    found = _stage(entry, subject, entry.source) if entry.source else None
    if found is None:
        return
    data, array = found[0], found[0][variable]
    ends = _ends(entry, subject, data, array)
    flags, reasons, population, hardest = (
        _values(entry, subject, key)
        for key in (entry.flag, entry.reason, entry.population, entry.hardest)
    )
    solved = None
    if array.dims == ("normal_force",):
        solved = subject.states("closure")["solved"]
    for place in np.ndindex(array.shape):
        at = dict(zip(array.dims, place, strict=True))
        row = _number(entry, [end[place] for end in ends], _at(flags, at), _at(reasons, at))
        if "missing" in row and solved is not None and not _at(solved, at):
            row = {"missing": _NOT_SOLVED}
        elif "value" in row:
            row |= _known("of_its_population", _at(population, at))
            row |= _known("hardest", _at(hardest, at))
            if entry.misfit and row["determined"]:
                misfit = percent(_values(entry, subject, entry.misfit).item())
                row["note"] = f"misses the curve by {misfit}"
        yield _beside(entry, data, at), row


def _ends(entry, subject, data, array):
    """Value with lower and upper end, from an interval or an error; missing without either."""
    value = np.asarray(array.values, float)
    low, high = names_of(str(array.name))[1:]
    if low in data and high in data:
        return value, data[low].values, data[high].values
    error = _values(entry, subject, entry.error)
    if error is None:
        nothing = np.full(value.shape, np.nan)
        return value, nothing, nothing
    half = error.transpose(*array.dims).values
    return Estimate.about(value, half, *entry.within).ends


def _at(array, at):
    """Value of an array over some of the dimensions of an entry; None without an array."""
    return None if array is None else array.isel({k: i for k, i in at.items() if k in array.dims})


def _number(entry, ends, flag, reason):
    """One number: missing where it is no result, undetermined where its stage says so."""
    why = "" if reason is None else str(reason.item())
    estimate = Estimate(*ends, reason=why, scale=DIMENSION if entry.dimension else SIZE)
    valid = flag is None or bool(np.nan_to_num(flag.item()))
    if not valid and not entry.range:  # what is no result, and no fit, is not printed as one
        return {"missing": why or (estimate.known and entry.note) or entry.missing}
    found = number(estimate, entry.missing)
    if estimate.known and entry.range:  # of a fit
        found["determined"] = valid and bool(estimate.determined)
        found |= {"note": why} if why else {}
    return found


def _known(key, found):
    """A further number of a row under this key, where it is known."""
    known = found is not None and math.isfinite(found.item())
    return {key: rounded(found.item())} if known else {}


def _beside(entry, data, at):
    """Coordinates of a row, and the variables of its `with`."""
    found: dict[str, Any] = {}
    for dim, index in at.items():
        name, coordinate, _ = _BESIDE[str(dim)]
        label = data[coordinate].variable[index].item()
        found[name] = label if isinstance(label, str) else rounded(label)
    return found | {name: rounded(_at(data[name], at).item()) for name in entry.beside}
