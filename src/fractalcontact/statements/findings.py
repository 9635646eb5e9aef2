"""What judges a statement: the joint's stages, verdicts, and rules that several share."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, wraps
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.fitting import FEWEST_POINTS, fit_line
from ..core.limits import LOOSELY, NEARLY, RESOLVED_NODES
from ..core.verdicts import FAILS, HOLDS, ILL_POSED, PARTLY, UNDETERMINED
from ..core.window import nominal_area
from ..mechanics.states import chosen_offset, forces_of

#: Why a joint under a hardness may be asked nothing of its contact area.
BY_CONSTRUCTION = "A_r = F/H by construction: all that touches yields"


class Finding(NamedTuple):
    """Verdict on one statement, the numbers that decide it, and what to know of them.

    Captions quote the verdict and the numbers; the note stands in the table alone.
    """

    verdict: str
    numbers: str
    note: str = ""


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

    def at_load(self, stage: str, name: str, force: float | None = None) -> np.ndarray:
        """A variable over offsets, NaN below ten nodes in contact.

        At the load of the maps, or another one, N.
        """
        nodes, values = (
            self._over_offsets(*of, force) for of in (("closure", "nodes"), (stage, name))
        )
        return np.where(nodes >= RESOLVED_NODES, values, np.nan)

    def _over_offsets(self, stage, name, force):
        values = self.stages[stage][name].sel(direction=self.direction)
        if "resolution" in values.dims:
            values = values.sel(resolution=values["resolution"].min())
        if "normal_force" in values.dims:
            force = self.force if force is None else force
            values = values.sel(normal_force=force, method="nearest")
        return values.values

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
        """Compliance of the interface over offsets at the load of the maps, mm/MPa."""
        return self.compliance_under(self.force)

    def compliance_under(self, force: float) -> np.ndarray:
        """Compliance d w_int / d sigma_0 of the interface over offsets, mm/MPa; NaN where flush."""
        return self.at_load("closure", "interface_compliance", force)

    @cached_property
    def area_fraction(self) -> np.ndarray:
        """A_r/A_0 over offsets, corrected for the perimeter."""
        area = self.at_load("closure", "area_corrected")
        return area / nominal_area(self.stages["specimens"])

    @cached_property
    def yields_everywhere(self) -> bool:
        """Whether A_r = F/H within 1 %, so that the pressure is the hardness alone.

        In every state at the scan's own resolution, and in most of the coarser ones.
        """
        hardness = self.settings["material"]["hardness"]
        curves = self.stages["closure"]
        if not np.isfinite(hardness):
            return False
        share = curves["area_corrected"] * hardness / curves["normal_force"]
        finest = share.sel(resolution=share["resolution"].min()).values
        within = [np.abs(one[np.isfinite(one)] - 1) < 0.01 for one in (finest, share.values)]
        return bool(within[0].size and within[0].all() and within[1].mean() > 0.5)

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


def of_the_area(check: Callable[[Joint], Finding]) -> Callable[[Joint], Finding]:
    """A check of a statement on the contact area, which is ill-posed where all of it yields."""

    @wraps(check)
    def asked(joint):
        if joint.yields_everywhere:
            return Finding(ILL_POSED, BY_CONSTRUCTION)
        return check(joint)

    return asked


def trend(
    v: np.ndarray, values: np.ndarray, chosen: np.ndarray, symbol: str, *, rising: bool
) -> Finding:
    """Whether values go with v as a power whose interval has the sign wanted."""
    chosen = chosen & (values > 0)
    line = fit_line(np.log(v[chosen]), np.log(values[chosen]))
    if not line.slope.known:
        return Finding(UNDETERMINED, no_offsets("three"))
    v = v[chosen]
    return Finding(
        by_sign(line.slope, rising=rising),
        f"x = {line.slope:z.2f}",
        f"{symbol} ~ v^x, v = {v[0]:.3g} to {v[-1]:.3g} mm",
    )


def under_every_load(joint: Joint, rule: Callable[[float], Finding]) -> Finding:
    """Finding of a rule at the load nearest to the maps' that decides, its verdict that of all.

    What a rule with a fixed limit finds at one load may be otherwise at the next.

    Parameters
    ----------
    joint : Joint
    rule : callable
        From a load, N, to its finding.
    """
    found = {force: rule(force) for force in joint.stages["closure"]["normal_force"].values}
    decided = {force: one for force, one in found.items() if one.verdict != UNDETERMINED}
    if not decided:
        return rule(joint.force)
    force = min(decided, key=lambda one: abs(np.log(one / joint.force)))
    verdicts = [one.verdict for one in decided.values()]
    pressure = force / nominal_area(joint.stages["specimens"])
    share_of = f"so at {verdicts.count(HOLDS)} of {len(decided)} loads"
    return decided[force]._replace(
        verdict=verdicts[0] if len(set(verdicts)) == 1 else PARTLY,
        numbers=f"{decided[force].numbers} at {pressure:.3g} MPa; {share_of}",
    )


def by_sign(found: Estimate, *, rising: bool) -> str:
    """Verdict on a claim of a sign, from the interval of what is to have it."""
    above, below = found.low > 0, found.high < 0
    above, below = (above, below) if rising else (below, above)
    return HOLDS if above else FAILS if below else UNDETERMINED


def level(values: np.ndarray, symbol: str, v: np.ndarray) -> Finding:
    """Whether values stay the same: their range over their mean."""
    known = np.isfinite(values)
    values, v = values[known], v[known]
    if len(values) < FEWEST_POINTS:
        return Finding(UNDETERMINED, no_offsets("three"))
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
