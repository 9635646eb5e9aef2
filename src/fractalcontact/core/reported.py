"""Contact states of a specimen that are published: direction, offset, grid and loads.

The stage that solves the states chooses the published ones once and stores their place with its
closure curves. Figures, pages, statements and comparisons read it there.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import xarray as xr

from .datasets import labelled

#: Type of a stage, or of one of its variables.
_States = TypeVar("_States", xr.Dataset, xr.DataArray)
#: Stored variables of the reported states: dimensions, unit, long name.
_VARIABLES = {
    "reported_direction": ((), "1", "direction of sliding whose states are reported"),
    "reported_offset": ((), "mm", "shear offset v whose states are reported"),
    "reported_resolution": ((), "1", "multiple k of the scan's spacing that is reported"),
    "reported_load": ("normal_force", "1", "loads whose dilatancy and strength are reported"),
    "reference_load": ("normal_force", "1", "load whose contact domains are looked at closely"),
}
#: Dimensions that name a direction.
_DIRECTIONS = ("direction", "contact_direction")


@dataclass(frozen=True, eq=False)
class Reported:
    """States of a specimen that are published.

    The direction is "none" without sliding, the offset in mm, the resolution a multiple of the
    scan's spacing. ``forces`` (n,) are the loads of the study, N, ascending; ``loads`` the numbers
    of those whose dilatancy and strength are reported, ``reference`` that of the load of the map
    states.
    """

    direction: str
    offset: float
    resolution: int
    forces: np.ndarray
    loads: tuple[int, ...]
    reference: int

    @classmethod
    def choose(
        cls,
        curves: xr.Dataset,
        *,
        direction: str,
        offset: float,
        loads: Sequence[float] | np.ndarray,
        reference: float,
    ) -> "Reported":
        """States nearest to those requested by a study, at the finest resolution.

        Curves are over ``offset`` (mm), ``resolution`` and ``normal_force`` (N); the offset is one
        of theirs. ``loads`` are the forces whose dilatancy is reported, N, ``reference`` the
        reference load.
        """
        forces = curves["normal_force"].values
        *dilating, of_reference = (
            int(np.argmin(np.abs(forces - force))) for force in (*loads, reference)
        )
        resolution = int(curves["resolution"].min())
        return cls(direction, offset, resolution, forces, tuple(sorted({*dilating})), of_reference)

    @classmethod
    def read(cls, curves: xr.Dataset) -> "Reported":
        """States as the closure curves of a specimen name them."""
        loads = np.flatnonzero(curves["reported_load"].values)
        return cls(
            str(curves["reported_direction"].values),
            float(curves["reported_offset"]),
            int(curves["reported_resolution"]),
            curves["normal_force"].values,
            tuple(int(load) for load in loads),
            int(np.flatnonzero(curves["reference_load"].values)[0]),
        )

    def variables(self) -> Mapping[str, tuple]:
        """Variables of the closure curves, as ``xr.Dataset`` takes them."""
        numbers = np.arange(self.forces.size)
        values = {
            "reported_direction": self.direction,
            "reported_offset": self.offset,
            "reported_resolution": self.resolution,
            "reported_load": np.isin(numbers, self.loads),
            "reference_load": numbers == self.reference,
        }
        return labelled(_VARIABLES, values)

    @property
    def quoted(self) -> list[int]:
        """Numbers of all loads with published numbers, ascending."""
        return sorted({*self.loads, self.reference})

    @property
    def force(self) -> float:
        """Reference load, N."""
        return float(self.forces[self.reference])

    def along(self, stage: xr.Dataset) -> xr.Dataset:
        """A stage in the reported direction."""
        return states_at(stage, direction=self.direction)

    def curves(self, stage: xr.Dataset) -> xr.Dataset:
        """A stage in the reported direction, at the reported resolution."""
        return states_at(stage, direction=self.direction, resolution=self.resolution)

    def states(self, stage: xr.Dataset) -> xr.Dataset:
        """A stage in the reported direction, at the reported offset and resolution."""
        return self.at_offset(self.curves(stage))

    def at_offset(self, states: _States) -> _States:
        """States at the reported offset, at every resolution that they are over."""
        return states_at(states, offset=self.offset)

    def state(self, stage: xr.Dataset) -> xr.Dataset:
        """A stage at the reported state under the reference load."""
        return self.states(stage).sel(normal_force=self.force, method="nearest")


def states_at(
    stage: _States,
    *,
    direction: str | None = None,
    offset: float | None = None,
    resolution: int | None = None,
) -> _States:
    """States at a direction, the nearest offset (mm) and a resolution, of those a stage is over."""
    labels = dict.fromkeys(_DIRECTIONS, direction) | {"resolution": resolution}
    place = {dim: label for dim, label in labels.items() if label is not None and dim in stage.dims}
    stage = stage.sel(place) if place else stage
    if offset is None or "offset" not in stage.dims:
        return stage
    return stage.sel(offset=offset, method="nearest")
