"""Nominal pressures at which the specimens of a study are compared: one for all rows of a table."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..core.subject import Subject

#: Pressures that differ by less than this fraction are one: loads are round numbers of N or MPa,
#: and windows differ a little in area.
ALIKE = 0.05


@dataclass(frozen=True)
class CommonLoad:
    """A nominal pressure, and the load of each specimen that was solved there.

    Attributes
    ----------
    key : str
        Its name on the page.
    pressure : float
        MPa, the median of theirs.
    numbers : dict of str to int
        Number of the load by specimen; those not solved there are left out.
    """

    key: str
    pressure: float
    numbers: dict[str, int]


def common_loads(subjects: Sequence[Subject]) -> list[CommonLoad]:
    """Pressures quoted of any specimen, ascending, with the loads of all specimens there.

    Parameters
    ----------
    subjects : sequence of Subject
    """
    quoted = sorted({float(_pressures(one)[i]) for one in subjects for i in one.reported.quoted})
    groups: list[list[float]] = []
    for pressure in quoted:
        if groups and pressure <= groups[-1][0] * (1 + ALIKE):
            groups[-1].append(pressure)
        else:
            groups.append([pressure])
    found: list[CommonLoad] = []
    for group in groups:
        middle = float(np.median(group))
        numbers = {one.name: i for one in subjects if (i := _number_at(one, middle)) is not None}
        pressures = [_pressures(one)[numbers[one.name]] for one in subjects if one.name in numbers]
        if pressures:
            found.append(CommonLoad(f"p{len(found)}", float(np.median(pressures)), numbers))
    return found


def _pressures(subject):
    return subject["closure"]["nominal_pressure"].values


def _number_at(subject, pressure):
    """Number of the load nearest to a pressure whose closure is known, None where none is near."""
    known = np.isfinite(subject.states("closure")["closure"].values)
    away = np.where(known, np.abs(np.log(_pressures(subject) / pressure)), np.inf)
    nearest = int(np.argmin(away))
    return nearest if away[nearest] <= np.log1p(ALIKE) else None


def main_load(loads: Sequence[CommonLoad], subjects: Sequence[Subject]) -> CommonLoad | None:
    """The load to show first: that of most specimens, then of most contact maps, then the largest.

    Parameters
    ----------
    loads : sequence of CommonLoad
    subjects : sequence of Subject
    """

    def rank(load):
        maps = sum(load.numbers.get(one.name) == one.reported.reference for one in subjects)
        return len(load.numbers), maps, load.pressure

    return max(loads, key=rank, default=None)
