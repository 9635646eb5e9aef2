"""Nominal pressures at which the specimens of a study are compared: one for all rows of a table."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..core.subject import Subject


@dataclass(frozen=True)
class CommonLoad:
    """Nominal pressure, and the number of the load of each specimen that was solved there.

    ``key`` is its name on the page, ``pressure`` that of the comparison of specimens, MPa.
    """

    key: str
    pressure: float
    numbers: dict[str, int]


def common_loads(
    subjects: Sequence[Subject], comparison: xr.Dataset | None = None
) -> list[CommonLoad]:
    """Pressures quoted of any specimen, ascending, with the loads of all specimens there.

    ``comparison``, the stage ``study_comparison``, has the pressure that each load is compared
    under; a single specimen has none.
    """
    compared = {subject.name: _compared(subject, comparison) for subject in subjects}
    solved = {
        subject.name: np.isfinite(subject.states("closure")["closure"].values)
        for subject in subjects
    }
    quoted = sorted(
        {float(compared[subject.name][i]) for subject in subjects for i in subject.reported.quoted}
    )
    loads: list[CommonLoad] = []
    for pressure in quoted:
        places = {name: np.flatnonzero(compared[name] == pressure) for name in compared}
        numbers = {
            name: int(place[0]) for name, place in places.items() if solved[name][place].any()
        }
        if numbers:
            loads.append(CommonLoad(f"p{len(loads)}", pressure, numbers))
    return loads


def _compared(subject, comparison):
    """Pressures that the loads of a specimen are compared under (n,), MPa."""
    if comparison is None:
        return subject["closure"]["nominal_pressure"].values
    return comparison["compared_pressure"].sel(specimen=subject.name).values


def main_load(loads: Sequence[CommonLoad], subjects: Sequence[Subject]) -> CommonLoad | None:
    """Load shown first: that of most specimens, then of most contact maps, then the largest."""

    def rank(load):
        maps = sum(
            load.numbers.get(subject.name) == subject.reported.reference for subject in subjects
        )
        return len(load.numbers), maps, load.pressure

    return max(loads, key=rank, default=None)
