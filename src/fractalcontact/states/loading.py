"""Loading of a joint: arguments of every solve, and lengths, forces, half-spaces that follow."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Generic, NamedTuple, TypeVar

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from roughcontact.elastic.halfspace import HalfSpace

from ..core.settings import JointSettings, Load, Solver
from ..core.window import nominal_area
from ..joint.contact_dips import STEPS, contact_dips
from ..joint.joint import composite_topography, direction_spacing, offsets_of
from ..joint.overlap import suspect_nodes
from .states import chosen_offset, forces_of, hardness_of

#: Settings of a joint, with the further fields that the receiver of a loading reads.
P = TypeVar("P", bound=JointSettings, covariant=True)
Q = TypeVar("Q", bound=JointSettings)


class Variant(NamedTuple):
    """Variant of the faces of a joint: its name, composite topography (mm) and suspicious nodes.

    Both arrays are (ny, nx), at the spacing of the scan.
    """

    name: str
    composite: np.ndarray
    suspicious: np.ndarray


@dataclass(frozen=True, eq=False)
class JointLoading(Generic[P]):
    """A joint at some shear offsets in one direction, under the loads of a study.

    Parameters
    ----------
    specimen, direction
        As for :func:`joint.joint.composite_topography`.
    cells : (n,) int array_like
        Shear offsets in cells of the scan; may be empty.
    settings : JointSettings
    solver : Solver
    """

    specimen: xr.Dataset
    direction: str
    cells: np.ndarray
    settings: P
    solver: Solver

    def __post_init__(self) -> None:
        object.__setattr__(self, "cells", np.asarray(self.cells, int))

    @staticmethod
    def of_joint(
        specimen: xr.Dataset,
        joint: xr.Dataset,
        direction: str,
        settings: Q,
        solver: Solver,
    ) -> "JointLoading[Q]":
        """The loading at all offsets of a joint.

        Parameters
        ----------
        specimen, direction, settings, solver
            As of the class.
        joint : xr.Dataset
            From :func:`joint.joint.describe_joint`.
        """
        cells = joint["offset_cells"].sel(contact_direction=direction).values
        return JointLoading(specimen, direction, cells, settings, solver)

    def at(self, cells: ArrayLike) -> "JointLoading[P]":
        """This loading at other offsets, in cells."""
        return replace(self, cells=np.atleast_1d(cells))

    def at_map_offset(self) -> "JointLoading[P]":
        """This loading at the offset of the contact maps alone."""
        offset = chosen_offset(self.settings.map_offset, self.offsets)
        return self.at(self.cells[self.offsets == offset][0])

    @property
    def slides(self) -> bool:
        """True if the joint can slide; a surface against a rigid plane cannot."""
        return self.direction != "none"

    @property
    def offsets(self) -> np.ndarray:
        """Shear offsets v (n,), mm."""
        return offsets_of(self.cells, direction_spacing(self.specimen, self.direction))

    @property
    def spacing(self) -> np.ndarray:
        """Sides (y, x) of a cell of the scan, mm."""
        return np.array([self.specimen.attrs[f"spacing_{axis}"] for axis in "yx"])

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the window."""
        rows, columns = (int(self.specimen.attrs[f"window_n{axis}"]) for axis in "yx")
        return rows, columns

    @property
    def area(self) -> float:
        """Nominal area A_0 of the window, mm2."""
        return nominal_area(self.specimen)

    @property
    def solving(self) -> dict[str, float]:
        """Options of :func:`contact.solve.solve_contact`.

        Raises
        ------
        InputError
            As :func:`states.states.hardness_of`.
        """
        return {
            "rtol": self.solver.rtol,
            "hardness": hardness_of(self.settings, self.specimen),
        }

    def forces(self, loads: Sequence[Load]) -> np.ndarray:
        """Loads as forces on the whole window, N, ascending."""
        return forces_of(loads, self.area)

    def composite(self, cells: int) -> np.ndarray:
        """Composite topography (ny, nx) of the window at an offset in cells, mm."""
        return composite_topography(self.specimen, self.direction, cells)

    def suspect_nodes(self, cells: int) -> np.ndarray:
        """Nodes (ny, nx) bool of the composite topography with suspicious cells of the scans in
        them.
        """
        return suspect_nodes(self.specimen, self.direction, cells)

    def variant(self, name: str, cells: int) -> Variant:
        """Composite topography at an offset of ``cells``, its suspicious nodes, and a name."""
        return Variant(name, self.composite(cells), self.suspect_nodes(cells))

    def contact_dips(self, cells: int, factor: int) -> list[np.ndarray]:
        """Apparent dips of the pre-fractal's nodes along the sliding, by step; none on a plane."""
        place = self.specimen, self.direction, cells, factor
        return [contact_dips(*place, step) for step in STEPS] if self.slides else []

    def half_space(self, shape: Iterable[int], factor: int = 1) -> HalfSpace:
        """The elastic half-space under a grid of ``factor`` times the scan's spacing."""
        rows, columns = (int(n) for n in shape)
        return HalfSpace(
            (rows, columns),
            tuple(self.spacing * factor),
            self.settings.material.e_star,
            kernel=self.solver.kernel,
            boundary=self.settings.boundary,
        )
