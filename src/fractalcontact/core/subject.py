"""One specimen of an atlas, as figures, pages and statements read it."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from .labels import REALISATIONS
from .reported import Reported
from .window import nominal_area


@dataclass(frozen=True, eq=False)
class Subject:
    """Specimen of an atlas: its stages by name, settings (mm, N and MPa) and reported states."""

    stages: Mapping[str, xr.Dataset]
    settings: Mapping[str, Any]
    name: str = ""

    @classmethod
    def of(cls, atlas: xr.DataTree, name: str) -> "Subject":
        """Specimen of an atlas; KeyError if the atlas has none of this name."""
        stages = {
            stage: group[name].to_dataset()
            for stage, group in atlas.children.items()
            if name in group.children
        }
        return cls(stages, configuration_of(atlas)["settings"][name], name)

    def __getitem__(self, stage: str) -> xr.Dataset:
        """Dataset of a stage."""
        return self.stages[stage]

    @cached_property
    def reported(self) -> Reported:
        """States that are published."""
        return Reported.read(self["closure"])

    @property
    def label(self) -> str:
        """Label as its user wrote it: untrusted text."""
        return str(self.settings["label"])

    @property
    def direction(self) -> str:
        """Reported direction of sliding."""
        return self.reported.direction

    @property
    def offset(self) -> float:
        """Reported offset, mm."""
        return self.reported.offset

    @property
    def forces(self) -> np.ndarray:
        """Loads of the study (n,), N, ascending."""
        return self.reported.forces

    @cached_property
    def members(self) -> str:
        """Kind of the members of its ensemble, `REALISATIONS` or `TWINS`; empty without one."""
        if "ensemble" not in self.stages:
            return ""
        return str(self["ensemble"].attrs.get("members", REALISATIONS))

    @property
    def realised(self) -> bool:
        """True if joints of its kind are judged on an ensemble; twins of a scan judge nothing."""
        return self.members == REALISATIONS

    @cached_property
    def area(self) -> float:
        """A_0 of the window, mm2."""
        return nominal_area(self["specimens"])

    def along(self, stage: str) -> xr.Dataset:
        """A stage in the reported direction, at every resolution."""
        return self.reported.along(self[stage])

    def curves(self, stage: str = "closure") -> xr.Dataset:
        """A stage in the reported direction, at the reported resolution, over offsets and loads."""
        return self.reported.curves(self[stage])

    def states(self, stage: str) -> xr.Dataset:
        """A stage at the reported direction, offset and resolution, over loads."""
        # The selection is cached, as a page reads a few numbers at each load.
        if stage not in self._states:
            self._states[stage] = self.reported.states(self[stage])
        return self._states[stage]

    def state(self, stage: str) -> xr.Dataset:
        """A stage at the reported state under the reference load."""
        return self.reported.state(self.states(stage))

    @cached_property
    def _states(self) -> dict[str, xr.Dataset]:
        return {}


def configuration_of(atlas: xr.DataTree) -> dict[str, Any]:
    """Study and settings of an atlas."""
    return json.loads(atlas.attrs["configuration"])


def specimens_of(atlas: xr.DataTree) -> list[str]:
    """Names of the specimens, sorted, without measured contact maps."""
    return sorted(atlas["specimens"].children) if "specimens" in atlas.children else []
