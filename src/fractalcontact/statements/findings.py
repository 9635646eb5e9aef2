"""What judges a statement: the joint's stages, verdicts, and rules that several share."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.resolved import RESOLVED_NODES
from ..mechanics.states import chosen_offset, forces_of
from ..surface.specimen import nominal_area

HOLDS, PARTLY, FAILS = "holds", "holds in part", "does not hold"
#: The data cannot decide; the question has no meaning as it is put.
UNDETERMINED, ILL_POSED = "undetermined", "ill-posed"
VERDICTS = (HOLDS, PARTLY, FAILS, UNDETERMINED, ILL_POSED)

#: What is called nearly equal, nearly flat or nearly linear, and what is so in part.
NEARLY, LOOSELY = 0.1, 0.25


class Finding(NamedTuple):
    """Verdict on one statement, the numbers that decide it, and what to know of them.

    Captions quote the verdict and the numbers; the note stands in the table alone.
    """

    verdict: str
    numbers: str
    note: str = ""


class Statement(NamedTuple):
    """A statement of the paper, what judges it, and of which specimens it is asked.

    Attributes
    ----------
    figure : str
        Figures or section of the paper.
    claim : str
        In our words.
    check : callable
        Its name is that of the statement.
    material : str
        "rock" or "concrete" where the paper says it of one of them, else empty.
    slides : bool
        Whether only a joint that slides is asked.
    plastic : bool
        Whether a hardness can change the answer: these alone are asked of a specimen that stands
        in its study once more without one.
    """

    figure: str
    claim: str
    check: Callable[..., Finding]
    material: str = ""
    slides: bool = True
    plastic: bool = False


@dataclass(frozen=True)
class Joint:
    """A joint's stages, and what several statements ask of them.

    Attributes
    ----------
    stages : dict of str to xr.Dataset
        ``specimens``, ``joints``, ``closure``, ``dilatancy``, ``area``, ``windows``, ``domains``,
        ``scaling``, ``domain_measures``, ``size_test``.
    settings : dict
    """

    stages: dict
    settings: dict

    @cached_property
    def direction(self) -> str:
        """The direction judged."""
        return str(self.stages["joints"]["contact_direction"].values[0])

    @cached_property
    def force(self) -> float:
        """Load of the contact maps, N."""
        specimen = self.stages["specimens"]
        return float(forces_of([self.settings["map_load"]], nominal_area(specimen))[0])

    def at_load(self, stage: str, name: str) -> np.ndarray:
        """A variable over offsets, at the load of the maps; NaN below ten nodes in contact."""
        return np.where(self._resolved, self._over_offsets(stage, name), np.nan)

    def _over_offsets(self, stage, name):
        values = self.stages[stage][name].sel(direction=self.direction)
        if "resolution" in values.dims:
            values = values.sel(resolution=values["resolution"].min())
        if "normal_force" in values.dims:
            values = values.sel(normal_force=self.force, method="nearest")
        return values.values

    @cached_property
    def _resolved(self) -> np.ndarray:
        return self._over_offsets("closure", "nodes") >= RESOLVED_NODES

    def map_states(self, stage: str) -> xr.Dataset:
        """A stage at the offset of the contact maps (and the finest resolution), over loads."""
        states = self.stages[stage].sel(direction=self.direction)
        states = states.sel(offset=self.map_offset, method="nearest")
        if "resolution" in states["delta_sigma"].dims:
            states = states.sel(resolution=states["resolution"].min())
        return states

    def map_state(self, stage: str) -> xr.Dataset:
        """A stage at the offset and load of the contact maps."""
        return self.map_states(stage).sel(normal_force=self.force, method="nearest")

    def map_windows(self) -> xr.Dataset:
        """Parts of the window at the offset and nearest to the load of the contact maps."""
        windows = self.stages["windows"].sel(offset=self.map_offset, method="nearest")
        return windows.sel(normal_force=self.force, method="nearest")

    @cached_property
    def map_offset(self) -> float:
        """Offset of the contact maps, mm."""
        return chosen_offset(self.settings["map_offset"], self.offset)

    @cached_property
    def offset(self) -> np.ndarray:
        """Offsets solved, mm."""
        return self.stages["closure"]["offset"].values

    @cached_property
    def compliance(self) -> np.ndarray:
        """Compliance d w_int / d sigma_0 of the interface over offsets, mm/MPa; NaN where flush."""
        return 1 / self.at_load("closure", "interface_stiffness")

    @cached_property
    def area_fraction(self) -> np.ndarray:
        """A_r/A_0 over offsets, corrected for the perimeter."""
        area = self.at_load("closure", "area_corrected")
        return area / nominal_area(self.stages["specimens"])

    def of_direction(self, name: str) -> np.ndarray:
        """A variable of the joint in the direction judged."""
        return self.stages["joints"][name].sel(direction=self.direction).values

    @cached_property
    def initial(self) -> np.ndarray:
        """Offsets of the first stage of sliding: up to the correlation length, if it is reached."""
        length = self.of_direction("correlation_length")
        return (self.offset > 0) & (np.isnan(length) | (self.offset <= length))

    @cached_property
    def between(self) -> np.ndarray:
        """Offsets beyond the correlation length at which the faces still correlate."""
        unrelated = self.of_direction("uncorrelated_offset")
        beyond = self.offset > self.of_direction("correlation_length")
        return beyond & (~np.isfinite(unrelated) | (self.offset < unrelated))

    @cached_property
    def unrelated(self) -> np.ndarray:
        """Offsets at which the faces no longer correlate."""
        return self.offset >= self.of_direction("uncorrelated_offset")


def trend(
    v: np.ndarray, values: np.ndarray, chosen: np.ndarray, symbol: str, *, rising: bool
) -> Finding:
    """Whether values go with v as a power whose interval has the sign wanted."""
    chosen = chosen & (values > 0)
    line = fit_line(np.log(v[chosen]), np.log(values[chosen]))
    if not np.isfinite(line.slope):
        return Finding(UNDETERMINED, no_offsets("three"))
    v = v[chosen]
    return Finding(
        by_sign(line.slope_low, line.slope_high, rising=rising),
        f"x = {line.slope:z.2f} [{line.slope_low:z.2f}, {line.slope_high:z.2f}]",
        f"{symbol} ~ v^x, v = {v[0]:.3g} to {v[-1]:.3g} mm",
    )


def by_sign(low: float, high: float, *, rising: bool) -> str:
    """Verdict on a claim of a sign, from the interval of what is to have it."""
    above, below = (low > 0, high < 0) if rising else (high < 0, low > 0)
    return HOLDS if above else FAILS if below else UNDETERMINED


def level(values: np.ndarray, symbol: str, v: np.ndarray) -> Finding:
    """Whether values stay the same: their range over their mean."""
    known = np.isfinite(values)
    values, v = values[known], v[known]
    if len(values) < 2:
        return Finding(UNDETERMINED, no_offsets("two"))
    spread = np.ptp(values) / np.mean(values)
    verdict = HOLDS if spread <= NEARLY else PARTLY if spread <= LOOSELY else FAILS
    return Finding(
        verdict,
        f"{symbol} varies by {100 * spread:.0f} % of its mean",
        f"v = {v[0]:.3g} to {v[-1]:.3g} mm",
    )


def share(good: int, total: int) -> str:
    """Verdict on a claim that holds in some of all cases."""
    return HOLDS if good == total else PARTLY if good else FAILS


def no_offsets(needed: str) -> str:
    """Why a claim is undetermined."""
    return f"too few offsets: {needed} needed"
