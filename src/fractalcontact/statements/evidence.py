"""Numbers that statements on joints of a kind are judged by: of realisations, or of one specimen.

What the paper says of joints of a kind is judged on realisations of the kind, where the study has
them, and else on the specimen. The rule and its margin are the same: they ask for these numbers.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.fitting import MIN_POINTS, fit_line, slope_error
from ..core.intervals import mean_difference, mean_interval
from ..core.limits import MIN_NODES, NEAR_FULL
from ..core.text import compact
from ..core.verdicts import UNDETERMINED
from ..domain.departure import departure_of
from ..domain.isotropy import WAYS
from ..domain.null_models import TOO_SMALL
from ..domain.pressure_trend import pressure_trend
from ..domain.slope_curves import largest_departure
from .findings import Finding, Joint, difference_of

#: The two estimates of Delta_sigma, as their variables and in words.
ESTIMATES = {"area": "by A_r(s)", "box": "by boxes"}

#: Quantities over the offsets: variable of the stage closure, and its error if it has no interval.
AT_OFFSETS = {
    "compliance": ("interface_compliance", ""),
    "area": ("area_corrected", "area_corrected_error"),
}

#: Null models; estimates and box sides beside them.
_NULLS = ("random", "cut")
_ESTIMATED = ("local_slope", "local_slope_cut_difference", "delta_sigma_cut_difference")
_SIDES = ("local_slope_side", "local_slope_side_min", "local_slope_side_max")


class OverLoads(NamedTuple):
    """An estimate over nominal pressures, MPa, ascending."""

    estimate: Estimate
    pressures: np.ndarray


@dataclass(frozen=True)
class Trend:
    """Slope of Delta_sigma over the decades of load.

    ``departure`` is the slope of its excess over the bearing-area cut where that is not near 2;
    ``pressures`` (n,) are those of the fit, MPa.
    """

    slope: Estimate
    departure: Estimate
    pressures: np.ndarray


class Evidence:
    """Numbers of one specimen."""

    def __init__(self, joint: Joint) -> None:
        self.joint = joint

    def of(self, finding: Finding) -> Finding:
        """Finding with the evidence that it was judged on."""
        return finding

    @property
    def reference(self) -> str:
        """The reference pressure in words."""
        return f"at {compact(self.joint.force / self.joint.area)} MPa"

    def size_exponent(self, name: str) -> Estimate:
        """Exponent against the side b of sub-windows under the reference load."""
        return Estimate.read(self.joint.state("windows"), name)

    def closure_beyond_roughness(self) -> Estimate:
        """Exponent of the closure from first touch against b less that of sigma_z."""
        closure, roughness = (
            self.size_exponent(f"{of}_exponent") for of in ("closure", "roughness")
        )
        return difference_of(closure, roughness)

    def beyond_eq6(self, by: str) -> OverLoads:
        """Exponent of A_r/A_0 over b less that of eq. 6, of one of :data:`ESTIMATES`."""
        test = self.joint["size_test"].sel(estimator=by)
        test = test.isel(normal_force=~test["beyond_study"].values.astype(bool))
        return _known(Estimate.read(test, "area_difference"), test["nominal_pressure"].values)

    def area_dimension(self) -> Estimate:
        """Delta_sigma by A_r(s) under the reference load."""
        return Estimate.read(self.joint.state("scaling"), "delta_sigma")

    def area_bend(self) -> Estimate:
        """Delta_sigma by the two finest resolutions less that by the two coarsest."""
        return Estimate.read(self.joint.state("scaling"), "area_bend")

    def difference(self) -> OverLoads:
        """Delta_sigma by A_r(s) less that by boxes."""
        return _known(Estimate.read(self.joint.states("scaling"), "difference"), self._pressures)

    def box_dimension(self) -> tuple[OverLoads, np.ndarray]:
        """Delta_sigma by boxes, and that of as many random nodes at these loads."""
        states = self.joint.states("domains")
        delta = Estimate.read(states, "delta_sigma")
        random = states["delta_sigma_random"].values
        return OverLoads(delta[delta.known], self._pressures[delta.known]), random[delta.known]

    def trend(self, by: str) -> Trend:
        """Trend with the load of one of :data:`ESTIMATES`.

        The interval of a slope is that of the line and that of the values in quadrature.
        """
        states = self.joint.states({"area": "scaling", "box": "domains"}[by])
        delta = Estimate.read(states, "delta_sigma")
        cut = np.full(delta.value.shape, np.nan)
        if by == "box":
            cut = delta.value - states["delta_sigma_cut_difference"].values
            cut = np.where(cut <= NEAR_FULL, cut, np.nan)
        forces, known = states["normal_force"].values, np.isfinite(delta.width)
        trend = pressure_trend(forces, np.where(known, delta.value, np.nan), cut)
        of_values = slope_error(np.log10(forces[known]), delta.width[known] / 2)
        line, departure = (_widened(fit.slope, of_values) for fit in (trend.line, trend.departure))
        return Trend(line, departure, self._pressures[known])

    def slopes(self) -> xr.Dataset:
        """Local slopes of box counts and departures from null models under all loads.

        Those of the stage ``domains``: ``local_slope`` and ``local_slope_cut_difference`` with
        their ends, ``local_slope_random``, ``local_slope_cut``, ``local_slope_side`` and its ends,
        ``local_slope_random_p``, ``local_slope_random_side``, those of the cut, ``null_verdict``
        and ``null_reason``.
        """
        return self.joint.states("domains")

    def offsets(self) -> np.ndarray:
        """Offsets v > 0 at which the contact of the joint was solved, mm, ascending."""
        return self.joint.offsets[self.joint.offsets > 0]

    def power_of_offset(self, name: str, chosen: np.ndarray) -> Estimate:
        """Exponent over some of the offsets of one of :data:`AT_OFFSETS`, at the reference load."""
        values = self._at_offsets(name, self.joint.force).value
        used = chosen & (values > 0)
        return fit_line(np.log(self.offsets()[used]), np.log(values[used])).slope

    def spread_over(self, name: str, chosen: np.ndarray, force: float) -> tuple[Estimate, int]:
        """Range of one of :data:`AT_OFFSETS` over its mean over some offsets, and their number.

        The ends of its interval are the least and the largest range that the solver's errors allow.
        """
        values = self._at_offsets(name, force)
        values = values[chosen & np.isfinite(values.value)]
        if values.value.size < MIN_POINTS:
            return Estimate(), int(values.value.size)
        least = max(values.low.max() - values.high.min(), 0.0)
        spread = Estimate(np.ptp(values.value), least, values.high.max() - values.low.min())
        return spread.mapped(lambda end: end / values.value.mean()), values.value.size

    def rise_over(self, name: str, before: np.ndarray, after: np.ndarray, force: float) -> Estimate:
        """Mean logarithm of one of :data:`AT_OFFSETS` at some offsets less that at others."""
        values = self._at_offsets(name, force).value
        known = np.isfinite(values)
        before, after = before & known, after & known
        if not before.any() or not after.any():
            return Estimate()
        return mean_difference(np.log(values[after]), np.log(values[before]))

    @property
    def judged_forces(self) -> np.ndarray:
        """Loads (n,), N, under which the offsets are compared."""
        return self.joint.forces

    def interval_difference(self) -> Estimate:
        """Exponent of occupied intervals across sliding less that along it, at reference load."""
        measures = self.joint.state("domain_measures")
        along, across = (Estimate.read(measures, f"interval_dimension_{way}") for way in WAYS)
        return difference_of(across, along)

    def rigid_slides(self) -> list[xr.Dataset]:
        """Rigid dilatancy of every realisation, as the stage ``joints`` has it; none of a joint."""
        return []

    def lag_dimension(self) -> Estimate:
        """Dimension of the composite topography over fixed lags (offset, lag_range)."""
        joints = self.joint["joints"]
        value = joints["lag_dimension"].transpose("offset", "lag_range").values
        value = value[self.joint.offsets > 0]
        return Estimate(value, value, value)

    def _at_offsets(self, name: str, force: float) -> Estimate:
        """One of :data:`AT_OFFSETS` over the offsets, missing below ten nodes in contact."""
        variable, error = AT_OFFSETS[name]
        value = self.joint.at_load("closure", variable, force)
        if error:
            half = self.joint.at_load("closure", error, force)
            estimate = Estimate(value, value - half, value + half)
        else:
            estimate = self.joint.estimate_at_load("closure", variable, force)
        return estimate[self.joint.offsets > 0]

    @property
    def _pressures(self) -> np.ndarray:
        return self.joint.forces / self.joint.area


class OfRealisations(Evidence):
    """Means over the realisations of an ensemble, with their intervals."""

    def __init__(self, joint: Joint) -> None:
        super().__init__(joint)
        self.stage = joint["ensemble"]

    @property
    def realisations(self) -> int:
        """Number of realisations."""
        return int(self.stage.sizes["realisation"])

    def of(self, finding: Finding) -> Finding:
        """Finding with the number of realisations that it was judged on."""
        # A finding without a note has no number, but the reason why there is none.
        of = "mean of" if finding.note else "in"
        judged_on = f"{self.realisations} realisations"
        evidence = "" if "realisations" in finding.numbers else f"; {of} {judged_on}"
        return finding._replace(numbers=finding.numbers + evidence, judged_on=judged_on)

    def size_exponent(self, name: str) -> Estimate:
        """Exponent against the side b of sub-windows under the reference load."""
        return self._mean(name)

    def closure_beyond_roughness(self) -> Estimate:
        """Mean exponent of the closure against b less that of sigma_z of the same realisation."""
        return mean_interval(
            (self.stage["closure_exponent"] - self.stage["roughness_exponent"]).values
        )

    def beyond_eq6(self, by: str) -> OverLoads:
        """Exponent of A_r/A_0 over b less that of eq. 6, under the reference load."""
        at = self._at_reference
        return _known(self._mean(f"eq6_{by}", at), at["nominal_pressure"].values)

    def area_dimension(self) -> Estimate:
        """Delta_sigma by A_r(s) under the reference load."""
        return self._mean("delta_sigma_area", self._at_reference)[0]

    def area_bend(self) -> Estimate:
        """Delta_sigma by the two finest resolutions less that by the two coarsest."""
        return self._mean("area_bend", self._at_reference)[0]

    def difference(self) -> OverLoads:
        """Delta_sigma by A_r(s) less that by boxes."""
        every = self._every("difference")
        return OverLoads(self._mean("difference")[every], self._pressures[every])

    def box_dimension(self) -> tuple[OverLoads, np.ndarray]:
        """Delta_sigma by boxes, and that of as many random nodes at these loads."""
        every = self._every("delta_sigma")
        delta = OverLoads(self._mean("delta_sigma")[every], self._pressures[every])
        return delta, self.stage["delta_sigma_random_mean"].values[every]

    def trend(self, by: str) -> Trend:
        """Trend with the load of one of :data:`ESTIMATES`."""
        name = {"area": "delta_sigma_area_trend", "box": "delta_sigma_trend"}[by]
        used = self.stage[f"{name}_used"].values.astype(bool)
        departure = self._mean("departure_trend") if by == "box" else Estimate()
        return Trend(self._mean(name), departure, self._pressures[used])

    def slopes(self) -> xr.Dataset:
        """Local slopes, as :meth:`Evidence.slopes` has them, of the mean over the realisations.

        Departures are of the mean difference, by Student's t of the realisations times the number
        of local slopes. A load under which a realisation holds fewer than ``MIN_NODES`` nodes has
        none.
        """
        stage = self.stage
        names = [
            *(f"{name}{end}" for name in _ESTIMATED for end in ("", "_low", "_high")),
            *(f"local_slope_{null}" for null in _NULLS),
        ]
        means = {name: stage[_of_mean(name)] for name in names}
        sides = {name: stage[name] for name in _SIDES}
        less = {null: self._mean(f"local_slope_{null}_difference") for null in _NULLS}
        enough = (stage["nodes"] >= MIN_NODES).all("realisation").values
        rows = [self._departures(less, load) if many else {} for load, many in enumerate(enough)]
        few = f"fewer than {MIN_NODES} nodes in contact in a realisation"
        missing = {"null_verdict": UNDETERMINED, "null_reason": few}
        columns = ("p", "side")
        names = [f"local_slope_{null}_{column}" for null in _NULLS for column in columns]
        table = {
            name: ("normal_force", [row.get(name, missing.get(name, np.nan)) for row in rows])
            for name in (*names, *missing)
        }
        return xr.Dataset({**means, **sides, **table})

    def offsets(self) -> np.ndarray:
        """Offsets at which the realisations were solved, mm, ascending."""
        return self.stage["offset"].values

    def power_of_offset(self, name: str, chosen: np.ndarray) -> Estimate:
        """Mean exponent over some of the offsets of one of :data:`AT_OFFSETS`."""
        rows = self._rows(name)[:, chosen]
        if rows.shape[1] < MIN_POINTS:
            return Estimate()
        lever = np.log(self.offsets()[chosen])
        lever = lever - lever.mean()
        return mean_interval(rows @ lever / (lever @ lever))

    def spread_over(self, name: str, chosen: np.ndarray, force: float) -> tuple[Estimate, int]:
        """Change between the smallest and the largest mean over some offsets, as a fraction."""
        rows = self._rows(name)[:, chosen]
        if rows.shape[1] < MIN_POINTS:
            return Estimate(), rows.shape[1]
        means = rows.mean(axis=0)
        change = mean_interval(rows[:, np.argmax(means)] - rows[:, np.argmin(means)])
        return change.mapped(np.expm1).within(0.0, np.inf), rows.shape[1]

    def rise_over(self, name: str, before: np.ndarray, after: np.ndarray, force: float) -> Estimate:
        """Mean logarithm at some offsets less that at others, of every realisation."""
        rows = self._rows(name)
        if not before.any() or not after.any():
            return Estimate()
        return mean_interval(rows[:, after].mean(axis=1) - rows[:, before].mean(axis=1))

    @property
    def judged_forces(self) -> np.ndarray:
        """The reference load alone: the only one under which the realisations slide."""
        return np.array([self.joint.force])

    def interval_difference(self) -> Estimate:
        """Mean exponent of occupied intervals across sliding less that along it."""
        return self._mean("interval_difference")

    def rigid_slides(self) -> list[xr.Dataset]:
        """Rigid dilatancy of every realisation, as the stage ``joints`` has it."""
        return [self.stage.isel(realisation=i) for i in range(self.realisations)]

    def lag_dimension(self) -> Estimate:
        """Mean dimension of the composite topography over fixed lags (offset, lag_range)."""
        ordered = self.stage.transpose(..., "offset", "lag_range")
        return Estimate.read(ordered, "lag_dimension_mean")

    def _rows(self, name: str) -> np.ndarray:
        """Logarithms of one of :data:`AT_OFFSETS` (realisation, offset); NaN where missing."""
        values = self.stage[f"{name}_slid"].transpose("realisation", "offset").values
        return np.log(np.where(values > 0, values, np.nan))

    def _departures(self, less: Mapping[str, Estimate], load: int) -> dict[str, Any]:
        """Departures of the mean local slopes from those of the null models under one load."""
        freedom, middles = self.realisations - 1, self.stage["local_slope_side"].values
        departures = {null: largest_departure(less[null][load], freedom) for null in _NULLS}
        row: dict[str, Any] = {"null_verdict": departure_of(**departures, surface=True)}
        row["null_reason"] = "" if np.isfinite(departures["random"].p) else TOO_SMALL
        for null, departure in departures.items():
            row |= departure.columns(null, middles)
        return row

    def _mean(self, name: str, stage: xr.Dataset | None = None) -> Estimate:
        return Estimate.read(self.stage if stage is None else stage, f"{name}_mean")

    def _every(self, name: str) -> np.ndarray:
        """Loads at which every realisation has a value; a mean over some would be that of those
        with most contact.
        """
        return self.stage[f"{name}_n"].values == self.realisations

    @property
    def _at_reference(self) -> xr.Dataset:
        """The ensemble under the reference load alone."""
        force = self.stage["normal_force"].values
        return self.stage.isel(normal_force=[int(np.argmin(np.abs(force - self.joint.force)))])

    @property
    def _pressures(self) -> np.ndarray:
        return self.stage["nominal_pressure"].values


def evidence_of(joint: Joint) -> Evidence:
    """Numbers that a statement on joints of a kind is judged by."""
    return OfRealisations(joint) if joint.realised else Evidence(joint)


def at_reference(joint: Joint, evidence: Evidence) -> xr.Dataset:
    """Local slopes and their departures under the reference load."""
    return joint.reported.state(evidence.slopes())


def of_a_kind(rule: Callable[[Joint, Evidence], Finding]) -> Callable[[Joint], Finding]:
    """Rule on joints of a kind, whose finding states its evidence."""

    @wraps(rule)
    def judged(joint: Joint) -> Finding:
        evidence = evidence_of(joint)
        return evidence.of(rule(joint, evidence))

    return judged


def _of_mean(name: str) -> str:
    """Variable of an ensemble that holds the mean of a quantity, or an end of its interval."""
    quantity, end = name, ""
    for ending in ("_low", "_high"):
        if name.endswith(ending):
            quantity, end = name.removesuffix(ending), ending
    return f"{quantity}_mean{end}"


def _known(estimate: Estimate, pressures: np.ndarray) -> OverLoads:
    """An estimate at the loads at which it has an interval."""
    known = np.isfinite(estimate.width)
    return OverLoads(estimate[known], pressures[known])


def _widened(slope: Estimate, half: float) -> Estimate:
    """A slope whose interval is widened by another error."""
    whole = np.hypot(slope.high - slope.value, half)
    return replace(slope, low=slope.value - whole, high=slope.value + whole)
