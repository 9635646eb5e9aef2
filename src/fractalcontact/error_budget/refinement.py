"""States of a load curve on finer grids, solved where the requested accuracy needs them.

At s/2 a few loads are solved, at s/4 those of them whose closure changed by more than the study
asks for; what lies between is interpolated.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace

from ..core.settings import ContactSettings, Load
from ..domain.box_dimension import dimension_of_domain
from ..states.loading import JointLoading
from ..states.numerical_error import NumericalError, closure_numerical_error, numerical_error
from ..states.state_quantities import STATE_QUANTITIES, state_quantities
from ..states.states import forces_of
from ..states.subgrid import subgrid_states, summit

#: Largest grids, in cells: at s/2, at s/4, and at s/4 of a study that requests all states.
MAX_CELLS_HALF, MAX_CELLS, MAX_CELLS_FULL = 2**22, 2**20, 2**22
#: Cells of a grid at s/4 up to which it is solved at all chosen loads, as it costs little.
CHEAP_CELLS = 2**18
#: Tolerance of refined states over that of the study; it is smaller because differences count.
TIGHTER = 0.1

#: Spacings compared, as divisors of the scan's.
FACTORS = (1, 2, 4)

#: Quantities of the budget: unit, long name. Axes ``quantity`` of arrays have their order.
BUDGET_QUANTITIES = STATE_QUANTITIES | {"delta_sigma": ("1", "Delta_sigma by box counting")}
#: Variables of the atlas, STAGE/VARIABLE, by quantity.
PLACES = {
    "closure": "closure/interface_closure",
    "separation": "closure/separation",
    "area_corrected": "closure/area_corrected",
    "stiffness": "closure/interface_stiffness",
    "delta_sigma": "domains/delta_sigma",
}
#: Quantities that may be zero or of either sign: their errors are stated in their unit, never as a
#: fraction. Faces pressed into each other have a separation below zero, single nodes no dimension.
ABSOLUTE = ("separation", "delta_sigma")


@dataclass(frozen=True, eq=False)
class LoadCurve:
    """Load curve of one offset at one resolution, whose errors are requested.

    The composite topography h and the largest height at zero offset, ``reference``, from which
    dilatancy counts (against a plane, the mean), are in mm; ``curve`` and ``domains`` are the
    stages ``closure`` and ``domains`` there, over normal_force.
    """

    loading: JointLoading
    composite: np.ndarray
    reference: float
    resolution: int
    curve: xr.Dataset
    domains: xr.Dataset

    @property
    def forces(self) -> np.ndarray:
        """F, N, ascending."""
        return self.curve["normal_force"].values

    @property
    def space(self) -> HalfSpace:
        """The half-space of its own grid."""
        return self.loading.half_space(self.composite.shape, self.resolution)

    @property
    def where(self) -> str:
        """Name of the loaded specimen, for errors."""
        return f"specimen {self.loading.specimen.attrs['name']}, errors"

    @property
    def separation(self) -> np.ndarray:
        """Separation of the mean planes (normal_force), mm."""
        return self.composite.max() - self.reference - self.curve["closure"].values

    def values(self) -> np.ndarray:
        """Values (quantity, normal_force) of :data:`BUDGET_QUANTITIES`."""
        curve = self.curve
        return self.over_quantities(
            closure=curve["interface_closure"].values,
            separation=self.separation,
            area_corrected=curve["area_corrected"].values,
            stiffness=curve["interface_stiffness"].values,
            delta_sigma=self.domains["delta_sigma"].values,
        )

    def over_quantities(self, otherwise: float = np.nan, /, **numbers: ArrayLike) -> np.ndarray:
        """Numbers (quantity, normal_force) by the names of :data:`BUDGET_QUANTITIES`."""
        rows = [np.asarray(numbers.get(name, otherwise), float) for name in BUDGET_QUANTITIES]
        return np.array([np.broadcast_to(row, len(self.forces)) for row in rows])

    def decay_length(self) -> np.ndarray:
        """sigma_0/(d sigma/d w_int) (normal_force), mm: over it the pressure falls by e.

        Where states that yield have no stiffness, it is that of the curve through the loads.
        """
        pressure = self.forces / self.loading.area
        length = pressure / self.curve["interface_stiffness"].values
        missing = np.isnan(self.curve["stiffness"].values)
        if missing.any() and len(length) > 1:
            of_curve = np.gradient(self.curve["interface_closure"].values, np.log(self.forces))
            length = np.where(missing, of_curve, length)
        return length


@dataclass(frozen=True, eq=False)
class Refinement:
    """Numbers of a load curve on finer grids.

    ``error``, ``limit`` and ``order`` (quantity, normal_force) are those of
    :mod:`states.numerical_error`, NaN where nothing was solved; ``finest`` (normal_force,) is the
    divisor of the finest spacing solved, 1 where none was.
    """

    error: np.ndarray
    limit: np.ndarray
    order: np.ndarray
    finest: np.ndarray


def refined_loads(curve: LoadCurve, settings: ContactSettings, *, all_states: bool) -> np.ndarray:
    """Loads that are solved on finer grids: indices (n,) of the forces, ascending.

    That of the seat is among them. None where the grid is too large or the faces are flush.
    """
    too_many = FACTORS[1] ** 2 * curve.composite.size > MAX_CELLS_HALF
    if np.ptp(curve.composite) == 0 or too_many:
        return np.empty(0, int)
    if all_states:
        return np.flatnonzero(_solved_loads(curve))
    at_seat = np.flatnonzero(curve.curve["seated_closure"].values == 0)[:1]
    return np.union1d(chosen_loads(curve, settings.drawn_loads), at_seat)


def chosen_loads(curve: LoadCurve, named: Sequence[Load]) -> np.ndarray:
    """Indices (n,) of solved loads: the smallest, the largest and the named ones."""
    solved = _solved_loads(curve)
    wanted = np.isin(curve.forces, forces_of(named, curve.loading.area))
    if solved.any():
        wanted[np.flatnonzero(solved)[[0, -1]]] = True
    return np.flatnonzero(wanted & solved)


def _solved_loads(curve: LoadCurve) -> np.ndarray:
    return np.isfinite(curve.curve["closure"].values) & (curve.curve["nodes"].values > 0)


def refine(curve: LoadCurve, settings: ContactSettings, asked: float | None) -> Refinement:
    """Numerical errors of a load curve; raises `NotConverged`.

    ``asked`` is the error of a closure that the study asks for, a fraction; None where it requests
    all states.
    """
    published = curve.values()
    levels = np.full((len(FACTORS), *published.shape), np.nan)
    levels[0] = published
    places = refined_loads(curve, settings, all_states=asked is None)
    finest = np.ones(len(curve.forces), int)
    for level, factor in enumerate(FACTORS[1:], 1):
        if level == 2:
            places = _needing_more(curve, levels, places, asked)
        for place, numbers in zip(places, _solved(curve, factor, places), strict=True):
            levels[level, :, place] = numbers
            finest[place] = factor
    return _errors(curve, levels, finest)


def _needing_more(curve, levels, places, asked) -> np.ndarray:
    """Loads solved at s/4: their closure changed by more than is asked for, or they cost little."""
    cells = FACTORS[2] ** 2 * curve.composite.size
    if cells <= CHEAP_CELLS:
        return places
    if cells > (MAX_CELLS_FULL if asked is None else MAX_CELLS):
        return np.empty(0, int)
    closures = levels[:, list(BUDGET_QUANTITIES).index("closure")]
    change = np.abs(closures[1] / closures[0] - 1)
    return places if asked is None else places[change[places] > asked]


def _solved(curve, factor, places):
    """Quantities of refined states, one row a load."""
    if not places.size:
        return
    loading = curve.loading
    solving = {**loading.solving, "rtol": TIGHTER * loading.solving["rtol"]}
    forces = curve.forces[places]
    states = subgrid_states(curve.composite, curve.space, factor, forces, solving, curve.where)
    for place, (state, highest) in zip(places, states, strict=True):
        limits = tuple(float(curve.domains[f"fit_{end}"][place]) for end in ("min", "max"))
        yield budget_values(state, highest, curve.reference, limits)


def budget_values(
    state: ContactState, highest: float, reference: float, limits: tuple[float, float] | None
) -> list[float]:
    """Values of :data:`BUDGET_QUANTITIES` of a state.

    ``highest`` and ``reference`` as for :func:`states.state_quantities.state_quantities`,
    ``limits`` as for :func:`budget_dimension`.
    """
    return in_order(
        state_quantities(state, highest, reference),
        delta_sigma=budget_dimension(state, limits),
    )


def in_order(quantities: Mapping[str, float], *, delta_sigma: float) -> list[float]:
    """Quantities of a state and its Delta_sigma as an axis ``quantity`` has them."""
    values = {**quantities, "delta_sigma": delta_sigma}
    return [values[name] for name in BUDGET_QUANTITIES]


def budget_dimension(state: ContactState, limits: tuple[float, float] | None) -> float:
    """Delta_sigma of a state over boxes within limits, mm; NaN if they are not finite."""
    if limits is not None and not np.isfinite(limits).all():
        return np.nan
    side = float(np.sqrt(state.space.cell_area))
    return dimension_of_domain(state.in_contact, side, fit_range=limits).dimension


def _errors(curve, levels, finest) -> Refinement:
    """Errors from the values at all spacings."""
    rise = summit(curve.composite) - float(curve.composite.max())
    by_name = dict(zip(BUDGET_QUANTITIES, levels.swapaxes(0, 1), strict=True))
    errors = curve_errors(by_name, curve.curve["area"].values, curve.decay_length(), rise)
    solved = finest > 1
    error, limit, order = (
        np.where(solved, np.array(values), np.nan)
        for values in zip(*(errors[name] for name in BUDGET_QUANTITIES), strict=True)
    )
    return Refinement(error, limit, order, finest)


def curve_errors(
    levels: Mapping[str, np.ndarray],
    raw_area: np.ndarray,
    decay_length: np.ndarray,
    rise: float,
) -> dict[str, NumericalError]:
    """Numerical errors of a load curve by quantity.

    ``levels`` has by name the :data:`STATE_QUANTITIES`, and Delta_sigma or not, each at s, s/2 and
    s/4 over the loads (3, normal_force); NaN where it was not solved. At s the raw area N s^2
    (normal_force,) is in mm2, the length sigma_0/(d sigma/d w_int) in mm; the summit of the surface
    is above its highest node by ``rise``, mm.
    """
    areas, stiffnesses = levels["area_corrected"], levels["stiffness"]
    edge = (raw_area - areas[0]) / raw_area
    length = decay_length * edge
    edges = {
        "separation": length,
        "area_corrected": areas[0] * edge,
        "stiffness": stiffnesses[0] * edge,
    }
    errors = {
        name: numerical_error(name, values, edges.get(name, 0.0))
        for name, values in levels.items()
        if name != "closure"
    }
    closure, separations = levels["closure"][0], levels["separation"]
    return errors | {"closure": closure_numerical_error(closure, separations, length, rise)}
