"""Problem, matrix, sums without FFT and final check shared by the comparison solvers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.contact.solve import checked_hardness, checked_problem
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

# Most products (10 ms) that the final check sums directly, independently of the FFT. The FFT is
# always faster: 400 loads on 512 x 512 take 0.5 s directly, 0.015 s by FFT.
LARGEST_SUM = 3_000_000


class NotOffered(ValueError):
    """Error of a method on a kind of problem that it does not solve; the text names the kind."""


def has_holes(composite: ArrayLike) -> bool:
    """True if a composite topography has cells without a height."""
    return not np.isfinite(composite).all()


@dataclass(frozen=True)
class ContactProblem:
    """A valid contact problem, as the methods of the package take it.

    Attributes
    ----------
    space : HalfSpace
    clearance : (ny, nx) ndarray
        Opening at first touch, mm.
    load : float
        Closure w, mm, or force F, N.
    by_force : bool
        True if the load is a force.
    hardness : float
        Largest pressure, MPa; infinite without one.
    start : ContactState or None
    rtol : float
        Largest violation allowed of the contact conditions, relative to the closure.
    """

    space: HalfSpace
    clearance: np.ndarray
    load: float
    by_force: bool
    hardness: float
    start: ContactState | None
    rtol: float

    @property
    def force(self) -> float | None:
        """F, N, where it is given."""
        return self.load if self.by_force else None

    def checked_state(
        self, pressure: np.ndarray, closure: float, *, iterations: int, reason: str
    ) -> ContactState:
        """State of a pressure, MPa, and a closure, mm, whose contact conditions are verified.

        ``iterations`` count the method's work. NotConverged with ``reason`` if a point in contact
        is not closed, a point outside penetrates, or the force is another.
        """
        state = measured_state(
            self.space,
            self.clearance,
            pressure,
            closure,
            force=self.force,
            iterations=iterations,
            hardness=self.hardness,
        )
        if not state.residual <= self.rtol:
            raise NotConverged(reason, state, state.residual)
        return state


def posed_problem(
    composite: ArrayLike,
    space: HalfSpace,
    *,
    closure: float | None,
    force: float | None,
    start: ContactState | None,
    rtol: float,
    hardness: float | None,
) -> ContactProblem:
    """A valid contact problem; arguments and errors are those of `fractalcontact.solve_contact`."""
    if isinstance(space, HalfSpace) and not space.is_free:
        raise ValueError(f"methods of comparison know free windows, not {space.boundary} ones")
    load, clearance = checked_problem(composite, space, closure, force, start, rtol)
    limit = checked_hardness(hardness, space, force)
    return ContactProblem(space, clearance, load, force is not None, limit, start, rtol)


def influence_matrix(space: HalfSpace, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Displacement (m, n), mm/MPa, at m nodes ``rows`` under unit pressure at n nodes ``columns``.

    Both are (ny, nx) masks.
    """
    influence = space.influence() * (space.cell / space.modulus)
    (row_y, row_x), (column_y, column_x) = np.nonzero(rows), np.nonzero(columns)
    return influence[
        np.abs(row_y[:, None] - column_y[None, :]),
        np.abs(row_x[:, None] - column_x[None, :]),
    ]


def sum_displacement(space: HalfSpace, pressure: np.ndarray) -> np.ndarray:
    """Displacement (ny, nx), mm, under a pressure, MPa, by direct summation over loaded cells."""
    ny, nx = space.shape
    table = space.influence()
    # The influence at distances of either sign, so that the field of a load is one slice of it.
    around = table[np.abs(np.arange(1 - ny, ny))][:, np.abs(np.arange(1 - nx, nx))]
    displacement = np.zeros(space.shape)
    for j, i in np.argwhere(pressure):
        field = around[ny - 1 - j : 2 * ny - 1 - j, nx - 1 - i : 2 * nx - 1 - i]
        displacement += pressure[j, i] * field
    return displacement * (space.cell / space.modulus)


def in_stress(values: np.ndarray, unit: float, hardness: float) -> np.ndarray:
    """Pressures counted in ``unit`` as MPa, those at the cap exactly at it."""
    return np.where(values >= hardness / unit, hardness, values * unit)


def measured_state(
    space: HalfSpace,
    clearance: np.ndarray,
    pressure: np.ndarray,
    closure: float,
    *,
    force: float | None = None,
    iterations: int = 0,
    hardness: float = np.inf,
) -> ContactState:
    """State of a pressure with its violation of the contact conditions.

    Parameters
    ----------
    space : HalfSpace
    clearance : (ny, nx) ndarray
        Opening at first touch, mm.
    pressure : (ny, nx) ndarray
        MPa, from 0 to ``hardness``.
    closure : float
        w, mm.
    force : float or None
        Requested F, N, if any.
    iterations : int
        Work of the method.
    hardness : float
        Largest pressure, MPa: where it is reached the surfaces may overlap, but not part.
    """
    if np.count_nonzero(pressure) * pressure.size <= LARGEST_SUM:
        displacement = sum_displacement(space, pressure)
    else:
        displacement = space.convolve(pressure) * (space.cell / space.modulus)
    gap = displacement + clearance - closure
    total = float(pressure.sum()) * space.cell_area
    parted = gap[pressure > 0].max(initial=0.0)
    overlap = -gap[pressure < hardness].min(initial=0.0)
    # NaN violates no condition in comparisons, and must not pass for a state.
    worst = max(parted, overlap) if np.isfinite(total) else np.nan
    residual = worst / closure if worst != 0 and closure != 0 else worst
    if np.isfinite(hardness):
        residual = max(residual, pressure.max() / hardness - 1)
    if force:
        residual = max(residual, abs(total / force - 1))
    return ContactState(
        pressure=pressure,
        displacement=displacement,
        gap=gap,
        closure=closure,
        force=total,
        residual=float(residual),
        iterations=iterations,
        space=space,
        hardness=hardness,
    )
