"""Direct solution of symmetric positive definite equations on a grid, by the fastest library here.

CHOLMOD comes with `cvxopt`, which is under the GPL and therefore an optional dependency (the extra
``flow``); without it SuperLU of scipy solves the same equations.
"""

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

try:
    import cvxopt
    import cvxopt.cholmod
except ImportError:
    cvxopt = None
#: True if CHOLMOD can be imported.
HAS_CHOLMOD = cvxopt is not None


def factorised(
    lower: sparse.coo_array, *, cholmod: bool | None = None
) -> Callable[[np.ndarray], np.ndarray]:
    """Solver of A x = b, A symmetric and positive definite, its rows eliminated as they are.

    Parameters
    ----------
    lower : (n, n) sparse.coo_array
        Lower triangle of A with its diagonal, each entry once.
    cholmod : bool, optional
        True solves with CHOLMOD, False with SuperLU; unsaid, CHOLMOD where it is installed.

    Returns
    -------
    callable
        Gives x (n,) for b (n,).

    Raises
    ------
    ArithmeticError
        If a pivot is not positive: A is singular to the precision of the numbers.
    """
    if HAS_CHOLMOD if cholmod is None else cholmod:
        return _by_cholmod(lower)
    return _by_superlu(lower)


def _by_cholmod(lower):
    cholmod, matrix = cvxopt.cholmod, cvxopt.spmatrix(lower.data, *lower.coords, lower.shape)
    # Else it would compare the order with that of AMD, which takes as long as the factor.
    stated = cholmod.options
    cholmod.options = {**stated, "nmethods": 1, "postorder": False}
    try:
        factor = cholmod.symbolic(matrix, p=cvxopt.matrix(np.arange(lower.shape[0])))
    finally:
        cholmod.options = stated
    cholmod.numeric(matrix, factor)

    def solve(right: np.ndarray) -> np.ndarray:
        solution = cvxopt.matrix(right)
        cholmod.solve(factor, solution)
        return np.array(solution)[:, 0]

    return solve


def _by_superlu(lower):
    triangle = lower.tocsc()
    matrix = triangle + sparse.tril(triangle, -1, format="csc").T
    options = {"SymmetricMode": True}
    try:
        return splu(
            matrix.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options
        ).solve
    except RuntimeError as error:
        raise ArithmeticError(str(error)) from error
