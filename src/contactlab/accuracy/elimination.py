"""Elimination: contact sets reached by dropping the points in tension, none ever taken back.

The set is right if the inverse M of the influence matrix K has no positive entry off its diagonal.
On the interpenetrating points, of interference d, p = M (d + g) with gaps g >= 0 is then a
complementarity problem with a Z-matrix, and the paper's procedure is Chandrasekaran's for such
problems: gaps only grow on the way to their values, so that no point of the contact is dropped. If
M has a positive entry, a problem can be constructed whose first step drops a point wrongly.

R. Chandrasekaran, Opsearch 7 (1970) 263; R. W. Cottle, J.-S. Pang & R. E. Stone, The Linear
Complementarity Problem (1992), sect. 4.7.
"""

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled_dataset, titled
from fractalcontact.core.labels import cf_attrs
from roughcontact.elastic.halfspace import RIGID_PLATE_SELF_TERMS, HalfSpace
from roughcontact.errors import NotConverged

from ..methods.common import influence_matrix
from ..methods.registry import METHODS
from .hard_surfaces import closure_reaching, rough_heights

#: Kernel and ratio of the sides of a cell.
CASES = [(kernel, 1.0) for kernel in ("love", *RIGID_PLATE_SELF_TERMS)] + [
    ("love", ratio) for ratio in (2.0, 8.0, 50.0)
]
#: Window on which the inverse is examined, and the range of sides of the random problems.
WINDOW = (12, 12)
SIDES = (4, 14)
RTOL = 1e-6
#: Tolerances of the inner solves whose effect is shown.
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
#: Gap of the counter-example over the largest with which node j still interpenetrates.
_NEARLY = 0.9


def largest_off_diagonal(space: HalfSpace) -> float:
    """Largest entry of K^-1 off its diagonal, relative to the diagonal entry of its row.

    Negative where elimination is always right; principal submatrices then share the property
    (T. L. Markham, Proc. Am. Math. Soc. 36 (1972) 326).
    """
    inverse, diagonal = _inverse(space)
    np.fill_diagonal(inverse, -np.inf)
    return float((inverse / diagonal[:, None]).max())


def counter_example(space: HalfSpace, closure: float = 1.0) -> np.ndarray | None:
    """Topography on which the first step of elimination drops a point that is in contact.

    Heights (ny, nx) in mm, to be pressed to ``closure``, mm; None where the inverse has no positive
    entry. All nodes but j are in contact under pressure 1, but i under less than M_ij g_j. The
    first step, which takes the gap g_j for closed, has p_i - M_ij g_j < 0 there and drops i.
    """
    inverse, diagonal = _inverse(space)
    np.fill_diagonal(inverse, -np.inf)
    i, j = np.unravel_index((inverse / diagonal[:, None]).argmax(), inverse.shape)
    if not inverse[i, j] > 0:
        return None
    everywhere = np.ones(space.shape, dtype=bool)
    influence = influence_matrix(space, everywhere, everywhere)
    pressure = np.ones(len(influence))
    pressure[j] = 0.0
    # Node j remains just among the interpenetrating ones.
    gap = _NEARLY * (influence[j] @ pressure)
    pressure[i] = _NEARLY * inverse[i, j] * gap
    interference = influence @ pressure
    interference[j] -= gap
    return (closure * interference / interference.max()).reshape(space.shape)


#: Variables of `elimination`: dimensions, unit, long name.
_ELIMINATION = {
    "largest_off_diagonal": (
        "case",
        "1",
        "largest entry of the inverse influence matrix off its diagonal",
    ),
    "tried": ("case", "1", "random problems tried"),
    "wrong": ("case", "1", "problems on which a dropped point is left interpenetrating"),
    "force_error": ("case", "1", "largest relative error of the force of those"),
    "counter_example": (
        "case",
        "1",
        "1 where a problem constructed on purpose defeats it, 0 where none can be constructed",
    ),
    "lost": ("tolerance", "1", "fraction of problems that lose nodes of the contact"),
    "area_error": ("tolerance", "1", "largest error of A_r, relative"),
}


@titled("whether dropping points alone reaches the right contact set")
def elimination(draws: int = 200) -> xr.Dataset:
    """Frequency of wrong sets by the paper's algorithm, for each kernel.

    Parameters
    ----------
    draws : int
        Random rough problems per case.

    Returns
    -------
    xr.Dataset
        On ``case``, with ``kernel`` and ``ratio`` of the sides of a cell: ``tried``, ``wrong``, the
        largest ``force_error`` of those; ``largest_off_diagonal``; ``counter_example``, whether a
        constructed problem defeats it. On ``tolerance``, with Love's kernel: the fraction of
        problems that ``lost`` a node of the contact to an inexact solve, and the largest
        ``area_error`` of them.
    """
    by_case = zip(*[_case(kernel, ratio, draws) for kernel, ratio in CASES], strict=True)
    by_tolerance = zip(*[_inexact(tolerance, draws) for tolerance in TOLERANCES], strict=True)
    columns = [np.array(column) for column in (*by_case, *by_tolerance)]
    kernels, ratios = zip(*CASES, strict=True)
    return labelled_dataset(
        _ELIMINATION,
        dict(zip(_ELIMINATION, columns, strict=True)),
        coords={
            "tolerance": ("tolerance", list(TOLERANCES), cf_attrs("1", "tolerance of the solves")),
            "case": [f"{kernel}, cells {ratio:g}:1" for kernel, ratio in CASES],
            "kernel": ("case", list(kernels)),
            "ratio": ("case", list(ratios), cf_attrs("1", "ratio of a cell's sides")),
        },
        attrs={"rtol": RTOL, "window": WINDOW, "sides": SIDES},
    )


def _inexact(tolerance, draws):
    """Fraction of problems that lose contact nodes to inexact solves; largest error of A_r."""
    errors = []
    for draw in range(draws):
        height, space, closure = _random_problem(draw, "love", 1.0)
        inexact = METHODS["paper"](height, space, closure=closure, rtol=tolerance)
        exact = METHODS["dense"](height, space, closure=closure)
        if (exact.in_contact & ~inexact.in_contact).any():
            errors.append(abs(inexact.area / exact.area - 1))
    return len(errors) / draws, max(errors, default=0.0)


def _random_problem(draw, kernel, ratio):
    """A rough surface, its half-space and a closure."""
    generator = np.random.default_rng(draw)
    shape = tuple(int(n) for n in generator.integers(*SIDES, size=2))
    height = rough_heights(generator, shape, generator.uniform(0.1, 0.9))
    closure = closure_reaching(height, generator.uniform(0.3, 1)) * generator.uniform(1, 6)
    return height, HalfSpace(shape, (ratio, 1.0), 1.0, kernel=kernel), closure


def _case(kernel, ratio, draws):
    """Values of `_ELIMINATION` on a case."""
    wrong, worst = 0, 0.0
    for draw in range(draws):
        height, space, closure = _random_problem(draw, kernel, ratio)
        error = _error_of_elimination(height, space, closure)
        if error is not None:
            wrong, worst = wrong + 1, max(worst, error)
    space = HalfSpace(WINDOW, (ratio, 1.0), 1.0, kernel=kernel)
    height = counter_example(space)
    defeated = height is not None and _error_of_elimination(height, space, 1.0) is not None
    return largest_off_diagonal(space), draws, wrong, worst, int(defeated)


def _error_of_elimination(height, space, closure):
    """Relative error of the force where elimination ends on a wrong set; None on the right set."""
    try:
        METHODS["paper"](height, space, closure=closure, rtol=RTOL)
    except NotConverged as error:
        exact = METHODS["dense"](height, space, closure=closure)
        return abs(error.state.force / exact.force - 1)
    return None


def _inverse(space):
    """Inverse of the influence matrix, and its diagonal."""
    everywhere = np.ones(space.shape, dtype=bool)
    inverse = np.linalg.inv(influence_matrix(space, everywhere, everywhere))
    return inverse, np.diag(inverse).copy()
