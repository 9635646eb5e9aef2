"""Nominal pressures at which the specimens of a study are compared: one for all rows of a table."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..core.subject import Subject


@dataclass(frozen=True)
class CommonLoad:
    """A nominal pressure, and the load of each specimen that was solved there.

    Attributes
    ----------
    key : str
        Its name on the page.
    pressure : float
        MPa, as the comparison of specimens has it.
    numbers : dict of str to int
        Number of the load by specimen; those not solved there are left out.
    """

    key: str
    pressure: float
    numbers: dict[str, int]


def common_loads(
    subjects: Sequence[Subject], comparison: xr.Dataset | None = None
) -> list[CommonLoad]:
    """Pressures quoted of any specimen, ascending, with the loads of all specimens there.

    Parameters
    ----------
    subjects : sequence of Subject
    comparison : xr.Dataset, optional
        Stage ``study_comparison``, with the pressure that each load is compared under; a single
        specimen has none.
    """
    compared = {one.name: _compared(one, comparison) for one in subjects}
    solved = {one.name: np.isfinite(one.states("closure")["closure"].values) for one in subjects}
    quoted = sorted({float(compared[one.name][i]) for one in subjects for i in one.reported.quoted})
    found: list[CommonLoad] = []
    for pressure in quoted:
        places = {name: np.flatnonzero(compared[name] == pressure) for name in compared}
        numbers = {name: int(at[0]) for name, at in places.items() if solved[name][at].any()}
        if numbers:
            found.append(CommonLoad(f"p{len(found)}", pressure, numbers))
    return found


def _compared(subject, comparison):
    """Pressures that its loads are compared under (n,), MPa."""
    if comparison is None:
        return subject["closure"]["nominal_pressure"].values
    return comparison["compared_pressure"].sel(specimen=subject.name).values


def main_load(loads: Sequence[CommonLoad], subjects: Sequence[Subject]) -> CommonLoad | None:
    """Load to show first: that of most specimens, then of most contact maps, then the largest."""

    def rank(load):
        maps = sum(load.numbers.get(one.name) == one.reported.reference for one in subjects)
        return len(load.numbers), maps, load.pressure

    return max(loads, key=rank, default=None)
