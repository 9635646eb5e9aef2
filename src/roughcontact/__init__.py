"""Frictionless contact of rough surfaces on an elastic half-space, verified or refused.

    >>> from roughcontact import HalfSpace, solve_contact
    >>> space = HalfSpace(heights.shape, spacing, modulus)
    >>> state = solve_contact(heights, space, force=100.0)

Lengths are in mm, forces in N, pressures in MPa, or in any other consistent units. A state
satisfies the contact conditions to ``rtol``, or `NotConverged` is raised. Names are imported at
their first use, as numba takes half a second.
"""

from importlib import import_module
from typing import Any

#: Version of the solver and of fractalcontact, which contains it.
__version__ = "1.0.0"

#: Module of each name.
_HOMES = {
    "BranchState": ".contact.path",
    "ContactState": ".contact.state",
    "HalfSpace": ".elastic.halfspace",
    "NotConverged": ".errors",
    "load_path": ".contact.path",
    "solve_contact": ".contact.solve",
}
__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    if name == "kernel_cache":
        return import_module(".kernel_cache", __name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__", "kernel_cache"]
