"""Quantities of a contact state that are shown, read from ``quantities.yaml``: each stands once."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
import yaml

from .estimate import IN_PLANE, Estimate, Judged, names_of
from .subject import Subject

_FILE = Path(__file__).with_suffix(".yaml")


@dataclass(frozen=True)
class Shown:
    """A quantity, and where it is shown.

    Attributes
    ----------
    key : str
        "STAGE/VARIABLE".
    budget : str
        Quantity of the error budget whose total error it has; empty without.
    by_scan : bool
        Whether suspicious cells of the scans leave it undetermined.
    dimension : bool
        Whether it is a dimension, which its interval determines.
    signed : bool
        Whether it may be negative.
    over_windows : bool
        Whether its interval is one over other windows, which leaves the number itself determined.
    summary : str
        Its column in ``summary.csv``, without the unit; empty where it has none.
    page : str
        What the page of a specimen calls it; empty where it has no row of its own.
    index : str
        Heading of its column in the table of specimens; empty where it has none.
    extra : bool
        Whether that column is shown on demand alone.
    """

    key: str
    budget: str = ""
    by_scan: bool = False
    dimension: bool = False
    signed: bool = False
    over_windows: bool = False
    summary: str = ""
    page: str = ""
    index: str = ""
    extra: bool = False

    @property
    def stage(self) -> str:
        """Stage of the atlas."""
        return self.key.partition("/")[0]

    @property
    def variable(self) -> str:
        """Its name in that stage."""
        return self.key.partition("/")[2]

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest value that it can have."""
        if self.dimension:
            return IN_PLANE
        return -np.inf if self.signed else 0.0, np.inf

    def at(self, subject: Subject, load: int) -> "Value":
        """Value at the reported state under the load of this number."""
        states = subject.states(self.stage)
        unit = str(states[self.variable].attrs["units"])
        # These alone: xarray would index each of some hundred variables.
        state = states[[name for name in names_of(self.variable) if name in states]]
        state = state.isel(normal_force=load) if "normal_force" in states.dims else state
        own = f"{self.variable}_total"
        in_budget = "error_budget" in subject.stages and own in subject["error_budget"]
        has_interval = in_budget or all(end in state for end in names_of(self.variable))
        if in_budget:
            error = subject["error_budget"][own].sel(
                normal_force=subject.forces[load], method="nearest"
            )
            found = Estimate.about(state[self.variable].item(), error.item(), *self.bounds)
        elif has_interval:
            found = Estimate.read(state, self.variable)
            if self.over_windows:
                found = Judged(*found.ends, says=bool(found.known))
        else:
            found = Estimate(state[self.variable].item())
        return Value(found, "" if unit == "1" else unit, has_interval)

    def total(self, budget: xr.Dataset) -> xr.DataArray:
        """Total error for this surface; only of quantities with ``budget``."""
        if (own := f"{self.budget}_total") in budget:
            return budget[own]
        return budget["total"].sel(quantity=self.budget, drop=True)


class Value(NamedTuple):
    """A number with its unit, "" where it has none, and whether it has an interval."""

    estimate: Estimate
    unit: str
    has_interval: bool

    def columns(self, name: str) -> dict[str, float]:
        """Columns of a table, which end in the unit."""
        columns = self.estimate.columns(name, self.unit)
        return columns if self.has_interval else dict([next(iter(columns.items()))])


def shown_in(*places: str) -> tuple[Shown, ...]:
    """Quantities shown in any of some places: "summary", "page" or "index"."""
    return tuple(one for one in shown_quantities() if any(getattr(one, place) for place in places))


@cache
def shown_quantities() -> tuple[Shown, ...]:
    """All of them, in their order."""
    stated = yaml.safe_load(_FILE.read_text(encoding="utf-8"))
    return tuple(Shown(key, **entry) for key, entry in stated.items())


def bounds_of(variable: str) -> tuple[float, float]:
    """Least and largest value of a variable; infinite of one that is not in the register."""
    of = (one.bounds for one in shown_quantities() if one.variable == variable)
    return next(of, (-np.inf, np.inf))
