"""States of a specimen that the pages quote: one direction, one offset, and a few of the loads."""

import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from ..core.window import nominal_area
from ..mechanics.states import chosen_offset, forces_of

#: Stages that the pages read; the fields of contact, the largest, are not among them.
STAGES = (
    "specimens",
    "quality",
    "surface_dimension",
    "joints",
    "closure",
    "dilatancy",
    "area",
    "domains",
    "scaling",
    "error_budget",
    "elastic_model",
    "statements",
    "study_statements",
    "contact_maps",
)


@dataclass(frozen=True)
class Chosen:
    """A specimen of an atlas in the direction, and at the offset, of its contact maps.

    Attributes
    ----------
    atlas : xr.DataTree
        With :data:`STAGES`.
    name : str
    """

    atlas: xr.DataTree
    name: str

    def stage(self, name: str) -> xr.Dataset:
        """Dataset of a stage."""
        return self.atlas[f"{name}/{self.name}"].to_dataset()

    @cached_property
    def settings(self) -> dict[str, Any]:
        """What the study stated of it, in mm, N and MPa."""
        return configuration_of(self.atlas)["settings"][self.name]

    @cached_property
    def label(self) -> str:
        """As its user wrote it: untrusted text."""
        return str(self.settings["label"])

    @cached_property
    def direction(self) -> str:
        """The first whose contact was solved, which figures and statements look at."""
        return str(self.settings["contact_directions"][0])

    @cached_property
    def offset(self) -> float:
        """Offset of the contact maps, mm."""
        return chosen_offset(self.settings["map_offset"], self.stage("closure")["offset"].values)

    @cached_property
    def forces(self) -> np.ndarray:
        """Loads of the study, N, ascending."""
        return self.stage("closure")["normal_force"].values

    @cached_property
    def pressures(self) -> np.ndarray:
        """Their nominal pressures, MPa."""
        return self.stage("closure")["nominal_pressure"].values

    @cached_property
    def map_load(self) -> int:
        """Number of the load of the contact maps among them."""
        return self._nearest(self.settings["map_load"])

    @cached_property
    def quoted(self) -> list[int]:
        """Numbers of the loads to quote: those of the dilatancy, and that of the maps."""
        wanted = {self._nearest(load) for load in self.settings["dilatancy_loads"]}
        return sorted(wanted | {self.map_load})

    def _nearest(self, load):
        (force,) = forces_of([load], nominal_area(self.stage("specimens")))
        return int(np.argmin(np.abs(self.forces - force)))

    def values(self, stage: str, *names: str) -> xr.Dataset:
        """Variables of a stage at this direction and offset, at the finest resolution.

        Parameters
        ----------
        stage : str
        *names : str
            Of variables, all of them by default.

        Returns
        -------
        xr.Dataset
            Over what dimensions are left: ``normal_force`` where they have loads.
        """
        found = self.stage(stage)
        found = found[list(names)] if names else found
        for dimension in ("direction", "contact_direction"):
            if dimension in found.dims:
                found = found.sel({dimension: self.direction})
        if "offset" in found.dims:
            found = found.sel(offset=self.offset, method="nearest")
        if "resolution" in found.dims:
            found = found.sel(resolution=found["resolution"].min())
        return found


def configuration_of(atlas: xr.DataTree) -> dict[str, Any]:
    """Study and settings, as the atlas keeps them."""
    return json.loads(atlas.attrs["configuration"])


def specimens_of(atlas: xr.DataTree) -> list[str]:
    """Names of the specimens, sorted; measured contact maps are none."""
    return sorted(atlas["specimens"].children) if "specimens" in atlas.children else []


def finite(value: Any) -> float | None:
    """A number, or None where it is missing: JSON knows neither NaN nor infinity."""
    number = float(value)
    return number if np.isfinite(number) else None
