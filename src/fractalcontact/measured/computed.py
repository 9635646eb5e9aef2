"""Computed closure of a joint on the branch of a test, and with other constants."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from roughcontact.contact.path import LOAD, BranchState, load_path
from roughcontact.errors import NotConverged

from ..core.errors import InputError
from ..core.limits import HARDEST
from ..core.reported import Reported
from ..core.settings import MeasuredSettings, MeasuredTest
from ..joint.joint import prefractal
from ..states.loading import JointLoading
from ..states.settlement import window_settlement
from ..states.state_scalars import aperture
from .curve import Curve

#: Relative error of a modulus as laboratories state it.
MODULUS_ERROR = 0.1
#: Largest pressure on a joint as a fraction of its hardness.
CARRIED = 0.95
#: Number of states of a solved branch, evenly spaced in the logarithm of the pressure.
_STATES = 8


@dataclass(frozen=True, eq=False)
class Joint:
    """Joint at its reported offset: its loading as solved, and the inputs of other branches.

    ``loading`` is at that offset alone; ``curve`` is the interface closure, mm, of resolved states
    on loading over the nominal pressure, MPa; ``seat_closure`` that at the seat of the study.
    ``windows`` (n,) is its error over other windows at the points of ``curve``, mm, and ``hardest``
    that closure if contacts are three times as hard, without points where they are elastic.
    """

    loading: JointLoading[MeasuredSettings]
    factor: int
    curve: Curve
    seat_closure: float
    windows: np.ndarray
    hardest: Curve

    @classmethod
    def of(
        cls, loading: JointLoading[MeasuredSettings], closure: xr.Dataset, budget: xr.Dataset
    ) -> "Joint":
        """The joint of a closure stage and its error budget.

        The error of a closure between two pressures is that of the separation at both, for this
        surface: no sampling error enters, the window stands for the joint that was tested.
        """
        reported = Reported.read(closure)
        states = reported.states(closure)
        total = budget["total"].sel(quantity="separation").values
        error = np.fmax(total, states["separation_error"].values)
        resolved = states["interface_closure"].where(states["resolved"]).values
        pressure = states["nominal_pressure"].values
        curve = Curve.of(pressure, resolved, error)
        separation = budget["error"].sel(quantity="separation")
        windows = Curve.of(pressure, resolved, separation.sel(source="window").values).error
        harder = budget["hardest"].sel(quantity="closure").values
        hardest = Curve.of(pressure, np.where(np.isfinite(resolved), harder, np.nan), 0.0)
        seat = (states["interface_closure"] - states["seated_closure"]).values
        seat = seat[np.isfinite(seat)]
        at_seat = float(seat[0]) if seat.size else np.nan
        at_offset = loading.at_map_offset()
        return cls(at_offset, reported.resolution, curve, at_seat, windows, hardest)

    @property
    def hardness(self) -> float:
        """H, MPa, or infinity."""
        return float(self.loading.solving["hardness"])

    @cached_property
    def relief(self) -> float:
        """Range of the composite topography, mm: no closure is larger."""
        return float(np.ptp(self._composite))

    def on_branch(self, test: MeasuredTest, largest: float, modulus: float = 1.0) -> Curve:
        """Interface closure on the branch of a test, with modulus and H multiplied by a factor.

        All pressures scale with E*, where the hardness does too. What has crushed under the largest
        pressure that the joint has carried before, MPa, stays so. Raises `NotConverged` if a state
        on unloading could not be verified.
        """
        curve = self.curve
        if test.branch != LOAD and np.isfinite(self.hardness):
            lightest = max(test.seat / modulus, curve.x[0])
            curve = self.solved(test, lightest, largest / modulus, self.hardness)
        return replace(curve, x=curve.x * modulus)

    def apart(self, test: MeasuredTest, largest: float, datum: float, curve: Curve) -> np.ndarray:
        """Half-widths (n,) of the closure from a datum by what a test need not share, mm.

        At the points of a closure curve from that datum, on its own branch, by squares: up to three
        times harder contacts; of elastic ones a modulus that is off by :data:`MODULUS_ERROR`, as
        closures depend on pressure over modulus; and other windows of the joint.
        """
        windows = replace(self.curve, error=self.windows).since(datum)
        beside = [windows.at(curve.x).high - windows.at(curve.x).value]
        if np.isfinite(self.hardness):
            hardest = self.hardest
            if test.branch != LOAD:
                hardest = self.with_hardness(test, largest, HARDEST * self.hardness)
            beside.append(hardest.since(datum).at(curve.x).value - curve.y)
        elif curve.x.size > 1:
            slope = np.gradient(curve.y, np.log(curve.x))
            beside.append(MODULUS_ERROR * (slope - slope[0]))
        return np.sqrt(np.sum(np.nan_to_num(beside) ** 2, axis=0))

    def with_hardness(self, test: MeasuredTest, largest: float, hardness: float) -> Curve:
        """Interface closure on the branch of a test at another hardness, MPa; solved anew."""
        lightest = max(test.seat, self.curve.x[0])
        return self.solved(test, lightest, largest, hardness)

    def solved(self, test: MeasuredTest, lightest: float, largest: float, hardness: float) -> Curve:
        """Interface closure on loading up to a pressure or, after it, on unloading from there."""
        area = self.loading.area
        space = self.loading.half_space(self._composite.shape, self.factor)
        pressure = np.geomspace(lightest, largest, _STATES)
        up = pressure if test.branch == LOAD else pressure[-1:]
        down = pressure[:0] if test.branch == LOAD else pressure[-2::-1]
        path = self._path(test, np.concatenate([up, down]), hardness)
        force = np.array([state.force for state in path])
        closure = np.array([state.closure for state in path])
        closure -= window_settlement(space, force)
        # The error is that of the study's grid, which is the same at all loads.
        error = np.interp(np.log(force / area), np.log(self.curve.x), self.curve.error)
        return Curve.of(force / area, closure, error)

    def gaps_on_branch(
        self, test: MeasuredTest, largest: float, pressures: np.ndarray
    ) -> list[np.ndarray]:
        """Gaps (ny, nx), mm, on the branch of a test under pressures, MPa, in their order.

        ``largest`` is the pressure that the joint has carried before, from which it unloads.
        """
        if not len(pressures):
            return []
        order = np.argsort(pressures, kind="stable")
        path = pressures[order]
        if test.branch != LOAD:
            order = order[::-1]
            path = np.concatenate([[largest], pressures[order]])
        states = self._path(test, path, self.hardness)[-len(pressures) :]
        gaps = [aperture(state.contact) for state in states]
        return [gaps[place] for place in np.argsort(order)]

    def _path(
        self, test: MeasuredTest, pressures: np.ndarray, hardness: float
    ) -> list[BranchState]:
        """States under successive pressures, MPa; refused if the joint cannot carry the largest."""
        if (largest := pressures.max()) >= CARRIED * hardness:
            raise InputError(
                f"{test.file}: the joint has carried {largest:.3g} MPa, more than it can at a "
                f"hardness of {hardness:.3g} MPa; state a larger one in the material"
            )
        composite, forces = self._composite, (self.loading.area * pressures).tolist()
        space = self.loading.half_space(composite.shape, self.factor)
        try:
            return load_path(
                composite, space, forces=forces, hardness=hardness, rtol=self.loading.solver.rtol
            )
        except NotConverged as failure:
            name = self.loading.specimen.attrs["name"]
            failure.add_note(f"specimen {name}, test '{test.label}' at H = {hardness:g} MPa")
            raise

    @cached_property
    def _composite(self) -> np.ndarray:
        (cells,) = self.loading.cells
        return prefractal(self.loading.composite(int(cells)), self.factor)
