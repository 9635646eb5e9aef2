"""Other solvers of the same contact problem, for comparison only.

Each module offers ``solve_contact(composite, space, ...)`` with the call, the result and the errors
of `fractalcontact.solve_contact`. What a method does not offer (a given force, a hardness) is a
ValueError that says so. `METHODS` names them all; a module is imported when it is first called.
"""

from functools import partial
from importlib import import_module


def _solve_with(module, composite, space, **load):
    return import_module(f"{__package__}.{module}").solve_contact(composite, space, **load)


#: Name: solver. In order: direct elimination (the reference), the paper's own algorithm,
#: constrained conjugate gradients, projected Gauss-Seidel, non-negative least squares.
METHODS = {
    "dense": partial(_solve_with, "dense"),
    "paper": partial(_solve_with, "paper"),
    "polonsky-keer": partial(_solve_with, "polonsky_keer"),
    "gauss-seidel": partial(_solve_with, "gauss_seidel"),
    "nnls": partial(_solve_with, "nnls"),
}
