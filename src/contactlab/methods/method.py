"""A solver method to compare with, as its file declares it.

A file of this folder declares its methods in a list ``METHODS`` below the functions that they name.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from numpy.typing import ArrayLike

from roughcontact.contact.state import ContactState, unloaded_state
from roughcontact.elastic.halfspace import HalfSpace

from .common import NotOffered, has_holes, posed_problem
from .peers import PublicCode, solve_in_child

#: Nodes along the smallest window of methods that know dyadic ones only.
MIN_DYADIC = 32


@dataclass(frozen=True, kw_only=True)
class Method:
    """A solver method as its file declares it, with the call of `fractalcontact.solve_contact`.

    Attributes
    ----------
    name : str
        Name in tables, legends and messages.
    solver : callable
        ``solver(problem)`` gives the `ContactState` of a `common.ContactProblem`; of a public code,
        ``solver(height, space, **options)`` a `peers.PublicCode` made ready for one topography.
    order : float
        Its place among the others; equals are sorted by name.
    title : str
        Subject of the messages on capabilities it lacks; by default the name.
    loads : tuple of str
        Possible loads, ``"closure"``, ``"force"`` or both; it is timed at the first.
    hardness : tuple of str
        The loads under which the pressure can be capped at a hardness.
    kernels : tuple of str
        Possible influence kernels of `HalfSpace`; any if none is named.
    windows : str
        Possible windows: ``"any"``, or ``"dyadic"`` for squares of 32, 64, 128 ... square
        cells a side.
    holes : bool
        Whether it would take a cell without a height for one that never touches, which is another
        problem than the package's.
    warm : bool
        Whether a state to start from spares it work.
    direct : bool
        Whether it is exact but for rounding, whatever the tolerance.
    counts : str
        Unit of the ``iterations`` of its states; ``"applications"`` are those of the operator.
    largest : int or None
        Interpenetrating nodes beyond which a solve takes minutes or too much memory, of methods
        that write out the influence of every node on every other.
    rtol : float
        Default tolerance.
    likely : float
        Power of ten near the tolerance that brings the force within 1e-6 on 512 x 512 nodes.
    packages : tuple of str
        Packages to be installed; of public codes alone.
    options : mapping
        Keywords that choose it among several methods of one file.
    """

    name: str
    solver: Callable[..., Any]
    order: float = float("inf")
    title: str = ""
    loads: tuple[str, ...] = ("closure",)
    hardness: tuple[str, ...] = ()
    kernels: tuple[str, ...] = ()
    windows: str = "any"
    holes: bool = False
    warm: bool = False
    direct: bool = False
    counts: str = ""
    largest: int | None = None
    rtol: float = 1e-6
    likely: float = -5.0
    packages: tuple[str, ...] = ()
    options: Mapping[str, str] = field(default_factory=dict, hash=False)

    def __call__(
        self,
        composite: ArrayLike,
        space: HalfSpace,
        *,
        closure: float | None = None,
        force: float | None = None,
        start: ContactState | None = None,
        rtol: float | None = None,
        hardness: float | None = None,
    ) -> ContactState:
        """Press a composite topography against a rigid plane, as `fractalcontact.solve_contact`.

        ``start`` is of no use to a method that is not ``warm``. ``rtol`` is the largest violation
        allowed of the contact conditions, relative to the closure; of a public code the tolerance
        on a quantity of its own. The ``iterations`` of the state are in units of ``counts``.

        Raises
        ------
        NotOffered
            If the method does not solve such problems.
        ValueError
            As `fractalcontact.solve_contact`.
        NotConverged
            If the method does not end, or its state fails the check of the contact conditions.
        ChildFailed
            If a public code raises an error, crashes or takes too long.
        """
        if self.holes and has_holes(composite):
            title = self.title or self.name
            raise NotOffered(f"{title} cannot take missing cells: for it such a cell never touches")
        if lack := self._lack(closure, force, hardness, getattr(space, "kernel", "")):
            raise NotOffered(lack)
        load: dict[str, Any] = {
            "closure": closure,
            "force": force,
            "start": start,
            "hardness": hardness,
        }
        if not self.takes(space):
            raise NotOffered(
                f"{self.title or self.name} takes square windows of 32, 64, 128 ... square cells"
            )
        rtol = self.rtol if rtol is None else rtol
        if self.packages:
            # Imported once in the parent, which every child shares.
            for package in self.packages:
                import_module(package)
            return solve_in_child(self.set_up, composite, space, rtol=rtol, **load)
        problem = posed_problem(composite, space, rtol=rtol, **load)
        if problem.load == 0:
            return unloaded_state(problem.space, problem.clearance)
        state: ContactState = self.solver(problem)
        return state

    def set_up(self, height: ArrayLike, space: HalfSpace) -> PublicCode:
        """Public code made ready for one topography, mm."""
        code: PublicCode = self.solver(height, space, **self.options)
        return code

    def takes(self, space: HalfSpace) -> bool:
        """True if the method can solve the window of a half-space."""
        if self.windows == "any":
            return True
        (ny, nx), (dy, dx) = space.shape, space.spacing
        square = ny == nx and abs(dy - dx) <= 1e-9 * dx
        return square and nx >= MIN_DYADIC and nx & (nx - 1) == 0

    def _lack(self, closure, force, hardness, kernel):
        """Missing capability of the method for a problem, as a sentence; empty without one."""
        title = self.title or self.name
        for other, value in (("closure", closure), ("force", force)):
            if value is not None and other not in self.loads:
                only = self.loads[0]
                return f"{title} takes a {only} only: give {only}=, not {other}="
        if hardness is not None and not self.hardness:
            return f"{title} knows no hardness: leave hardness= out"
        if hardness is not None and ("closure" if force is None else "force") not in self.hardness:
            only = self.hardness[0]
            return f"{title} takes a hardness with a {only} only: give {only}="
        if kernel and self.kernels and kernel not in self.kernels:
            return f"{title} knows no kernel but {', '.join(self.kernels)}: not {kernel}"
        return ""
