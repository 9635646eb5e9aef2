"""Loading, unloading and reloading of contacts that crush: the permanent set of a load path.

While the load exceeds all earlier ones the pressure is limited by the hardness H, and nodes at H
are pressed in: loading, on heights h. At a turn of the load the permanent set is kept,

    h <- h + min(g, 0)    where p = H,

and until the load exceeds its maximum again the contact is elastic on these heights: unloading, and
reloading on the same curve. At the maximum the elastic state is the same, as none of its gaps is
negative any more; with a bound at H, nodes at H without overlap would be doubly degenerate. Loading
does not depend on its steps: the set is updated at turning points alone.

Perfect plasticity: a second cycle to the same load changes nothing, and the volume pressed in is
lost (rock is crushed, its volume is not conserved).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import field, real_array
from ..elastic.halfspace import HalfSpace
from ..threads import computed_once
from .solve import solve_contact
from .state import ContactState
from .topography import HasHeights, heights_of

LOAD, UNLOAD, RELOAD = "load", "unload", "reload"
#: Branches of a load path.
BRANCHES = (LOAD, UNLOAD, RELOAD)


@dataclass(frozen=True)
class BranchState:
    """State on a load path.

    Attributes
    ----------
    branch : str
        ``load`` above all earlier loads; below, ``unload`` where the load has fallen and ``reload``
        where it has risen since.
    closure : float
        w from first touch of the heights that the path began with, mm.
    permanent_set : (ny, nx) ndarray
        Permanent indentation of each node, mm.
    yielded : (ny, nx) bool ndarray
        Nodes that have carried the hardness.
    contact : ContactState
        On the heights at the beginning of the branch, permanent set included; its own closure is
        from first touch of these. Its ``stiffness`` is that of the branch.
    hardness : float or (ny, nx) ndarray
        MPa.
    """

    branch: str
    closure: float
    permanent_set: np.ndarray
    yielded: np.ndarray
    contact: ContactState
    hardness: float | np.ndarray

    def __repr__(self):
        return (
            f"<BranchState {self.branch}: force={self.force:.6g} N, closure={self.closure:.6g} mm, "
            f"set of {np.count_nonzero(self.permanent_set)} nodes, "
            f"dissipated={self.dissipated_energy:.3g} N mm>"
        )

    @property
    def force(self) -> float:
        """F, N."""
        return self.contact.force

    @property
    def pressure(self) -> np.ndarray:
        """p, MPa, (ny, nx)."""
        return self.contact.pressure

    @property
    def gap(self) -> np.ndarray:
        """Gap above the permanently deformed surface, mm, (ny, nx), nowhere negative."""
        return np.maximum(self.contact.gap, 0.0)

    @property
    def set_volume(self) -> float:
        """Volume of the permanent set, mm3."""
        return float(self.permanent_set.sum()) * self.contact.space.cell_area

    @property
    def plastic_load_fraction(self) -> float:
        """Fraction of the force on nodes at the hardness.

        It is 0 without a force, and on the branches ``unload`` and ``reload``, which are elastic.
        """
        at_limit = self.contact.pressure >= self.contact.hardness
        total = float(self.pressure.sum())
        return float(self.pressure[at_limit].sum()) / total if total > 0 else 0.0

    @computed_once
    def elastic_energy(self) -> float:
        """Energy recovered by unloading, sum p u s^2 / 2, N mm."""
        work = float((self.pressure * self.contact.displacement).sum())
        return work * self.contact.space.cell_area / 2

    @computed_once
    def dissipated_energy(self) -> float:
        """Energy dissipated since the path began, sum of H s^2 times the permanent set, N mm.

        A node is pressed in under the pressure H alone. With the elastic energy this is the work of
        the force, the integral of F dw: over a cycle, the area between its branches.
        """
        sunk = self.permanent_set > 0
        spent = np.broadcast_to(self.hardness, sunk.shape)[sunk] * self.permanent_set[sunk]
        return float(spent.sum()) * self.contact.space.cell_area


def loaded_state(contact: ContactState) -> BranchState:
    """State on the loading branch, with its permanent set.

    Parameters
    ----------
    contact : ContactState
        On the original heights, under its largest load so far.
    """
    held, yielded = np.zeros(contact.space.shape), np.zeros(contact.space.shape, bool)
    return _branch_state(LOAD, contact, contact.closure, held, yielded, contact.hardness)


def load_path(
    composite: ArrayLike | HasHeights,
    space: HalfSpace,
    *,
    forces: Sequence[float] | None = None,
    closures: Sequence[float] | None = None,
    mean_pressures: Sequence[float] | None = None,
    hardness: float | ArrayLike | None = None,
    rtol: float = 1e-6,
    loaded: ContactState | None = None,
) -> list[BranchState]:
    """States of contact under successive loads: up, down and up again.

    Below the largest load so far a branch is elastic and its pressures have no limit. Back at that
    load they equal the hardness again, to within the error of the solve.

    Parameters
    ----------
    composite : (ny, nx) array_like
        Composite topography h before any load, mm, as for `solve_contact`.
    space : HalfSpace
    forces : (k,) sequence of float, optional
        F, N. One of ``forces``, ``closures`` and ``mean_pressures`` is given.
    closures : (k,) sequence of float, optional
        w, mm, all from first touch of ``composite``. The force is 0 where contact is lost.
    mean_pressures : (k,) sequence of float, optional
        F over the area of the window, MPa.
    hardness : float or (ny, nx) array_like, optional
        H, MPa, as for `solve_contact`.
    rtol : float
        As for `solve_contact`.
    loaded : ContactState, optional
        State of the same topography and hardness under its first load, from which the path
        continues.

    Returns
    -------
    list of BranchState
        One state for each load, in their order.

    Raises
    ------
    ValueError, NotConverged
        As `solve_contact`.

    Examples
    --------
    A sphere of radius 1 mm, pressed in and released:

    >>> import numpy as np
    >>> from roughcontact import HalfSpace, load_path
    >>> y, x = (np.indices((64, 64)) - 31.5) * 0.01
    >>> space = HalfSpace((64, 64), 0.01, 1e4)
    >>> path = load_path(-(x**2 + y**2) / 2, space, forces=[50, 0], hardness=800)
    >>> [state.branch for state in path]
    ['load', 'unload']
    >>> bool(path[-1].permanent_set.max() > 0)
    True
    """
    choices = {"forces": forces, "closures": closures, "mean_pressures": mean_pressures}
    given = {name: values for name, values in choices.items() if values is not None}
    if len(given) != 1:
        raise ValueError("give exactly one of forces=, closures= and mean_pressures=")
    ((name, values),) = given.items()
    loads = real_array(values, name)
    if loads.ndim != 1 or not (np.isfinite(loads) & (loads >= 0)).all():
        raise ValueError(f"{name}: expected a list of finite numbers >= 0")
    if mean_pressures is not None:
        loads = loads * space.area
    height = field(heights_of(composite), "composite topography", space.shape)
    limit = np.inf if hardness is None else hardness
    path = _Path(height, space, limit, rtol)
    if loaded is not None:
        if loaded.space != space:
            raise ValueError("loaded: expected a state of this half-space")
        path.begin(loaded, loaded.force if closures is None else loaded.closure)
    return [path.next(float(load), by_force=closures is None) for load in loads]


class _Path:
    """Heights with the permanent set of the last turn, and the last state."""

    def __init__(self, height, space, hardness, rtol):
        self.first, self.space, self.hardness, self.rtol = height, space, hardness, rtol
        self.held, self.yielded = np.zeros(space.shape), np.zeros(space.shape, bool)
        self.height, self.lowered = height, 0.0
        self.branch, self.load, self.largest = LOAD, -np.inf, -np.inf
        self.state: BranchState | None = None

    def begin(self, contact, load):
        """Continue the path to a given force or closure, from a loading state."""
        self.state, self.load, self.largest = loaded_state(contact), load, load

    def next(self, load, *, by_force):
        """State of the next load."""
        beyond = load > self.largest
        if not beyond and self.branch == LOAD and load < self.load:
            self._turn()
        if beyond:
            self.branch = LOAD
        elif load != self.load:
            self.branch = UNLOAD if load < self.load else RELOAD
        self.load, self.largest = load, max(load, self.largest)
        contact = self._contact(load, by_force)
        closure = contact.closure + self.lowered
        history = closure, self.held, self.yielded, self.hardness
        self.state = _branch_state(self.branch, contact, *history)
        return self.state

    def _turn(self):
        """Subtract the permanent set of the last state from the heights of the following ones."""
        self.held, self.yielded = self.state.permanent_set, self.state.yielded
        self.height = self.first - self.held
        self.lowered = float(self.first.max() - self.height.max())

    def _contact(self, load, by_force):
        """State of a load on the present heights, bounded by the hardness on loading only."""
        start = None if self.state is None else self.state.contact.without_before()
        bound = self.hardness if self.branch == LOAD else None
        case = (self.height, self.space)
        if by_force:
            return solve_contact(*case, force=load, start=start, rtol=self.rtol, hardness=bound)
        reach = load - self.lowered
        closure = max(reach, 0.0)
        options = {"start": start, "rtol": self.rtol, "hardness": bound}
        contact = solve_contact(*case, closure=closure, **options)
        return replace(contact, gap=contact.gap - reach, closure=reach) if reach < 0 else contact


def _branch_state(branch, contact, closure, held, yielded, hardness):
    """State of a branch with the permanent set held before and the set it makes itself."""
    at_limit = contact.pressure >= contact.hardness
    return BranchState(
        branch=branch,
        closure=closure,
        permanent_set=held + np.where(at_limit, np.maximum(-contact.gap, 0.0), 0.0),
        yielded=yielded | at_limit,
        contact=contact,
        hardness=hardness,
    )
