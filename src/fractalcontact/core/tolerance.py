"""Tolerance of the solver from the requested accuracy of a study."""

from collections.abc import Mapping

#: Default accuracy of a study: relative for the closure, absolute for Delta_sigma.
ACCURACY = {"closure": "1 %", "delta_sigma": 0.02}
#: The solver's share of the requested errors. At a tolerance of 1e-3 closures of 250 states of
#: three twins were off by at most 7e-5 and Delta_sigma by 0.0017, at 1e-2 by 5e-4 (4 % where the
#: pressure is capped) and 0.006. So 1e-3 leaves a factor of ten and more to 1 % and 0.02.
SHARE_OF_CLOSURE = 0.1
SHARE_OF_DIMENSION = 0.05
#: Largest tolerance; at a looser one even the set of nodes in contact is wrong.
LOOSEST = 1e-2


def tolerance(accuracy: Mapping[str, float]) -> float:
    """Tolerance of the solver for an accuracy: ``closure`` relative, ``delta_sigma`` absolute."""
    return min(
        SHARE_OF_CLOSURE * accuracy["closure"],
        SHARE_OF_DIMENSION * accuracy["delta_sigma"],
        LOOSEST,
    )
