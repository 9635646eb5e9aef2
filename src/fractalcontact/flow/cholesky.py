"""Direct solution of symmetric positive definite equations on a grid, by the fastest library here.

CHOLMOD comes with `cvxopt`, which is under the GPL and therefore an optional dependency (the extra
``flow``); without it SuperLU of scipy solves the same equations.
"""

from importlib import import_module

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu


def cholmod_is_here() -> bool:
    """True if `cvxopt` can be imported."""
    try:
        import_module("cvxopt.cholmod")
    except ImportError:
        return False
    return True


def solve_symmetric(
    lower: sparse.coo_array, right: np.ndarray, *, cholmod: bool | None = None
) -> np.ndarray:
    """Solution of A x = b, A symmetric and positive definite.

    Parameters
    ----------
    lower : (n, n) sparse.coo_array
        Lower triangle of A with its diagonal, each entry once.
    right : (n, k) ndarray
        b.
    cholmod : bool, optional
        True solves with CHOLMOD, False with SuperLU; unsaid, CHOLMOD where it is installed.

    Returns
    -------
    (n, k) ndarray

    Raises
    ------
    ArithmeticError
        If a pivot is not positive: A is singular to the precision of the numbers.
    """
    if cholmod_is_here() if cholmod is None else cholmod:
        return _by_cholmod(lower, right)
    return _by_superlu(lower, right)


def _by_cholmod(lower: sparse.coo_array, right: np.ndarray) -> np.ndarray:
    cvxopt, cholmod = import_module("cvxopt"), import_module("cvxopt.cholmod")
    values, rows, columns = (
        cvxopt.matrix(np.ascontiguousarray(one)[:, np.newaxis].astype(kind))
        for one, kind in ((lower.data, float), (lower.row, np.int64), (lower.col, np.int64))
    )
    solution = cvxopt.matrix(np.asfortranarray(right))
    cholmod.linsolve(cvxopt.spmatrix(values, rows, columns, lower.shape), solution)
    return np.array(solution)


def _by_superlu(lower: sparse.coo_array, right: np.ndarray) -> np.ndarray:
    triangle = lower.tocsc()
    matrix = triangle + sparse.tril(triangle, -1, format="csc").T
    try:
        factor = splu(
            matrix.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise ArithmeticError(str(error)) from error
    return factor.solve(right)
