"""Does dropping the points in tension, and never taking one back, reach the right contact set?

It does where the inverse M of the influence matrix K has no positive entry off its diagonal. On the
interpenetrating points, of interference d, p = M (d + g) with gaps g >= 0 is then a complementarity
problem with a Z-matrix, and the paper's procedure is Chandrasekaran's for such problems: gaps only
grow on the way to their values, so that no point is dropped that belongs to the contact. Where M
has a positive entry, a scene can be made in which the first step drops a point wrongly.

R. Chandrasekaran, Opsearch 7 (1970) 263; R. W. Cottle, J.-S. Pang & R. E. Stone, The Linear
Complementarity Problem (1992), sect. 4.7.
"""

import numpy as np
import xarray as xr

from ..core.errors import NotConverged
from ..core.labels import cf_attrs
from ..elastic.halfspace import RIGID_PLATE_SELF_TERMS, HalfSpace
from ..methods.common import influence_matrix
from ..methods.registry import METHODS
from .hard_surfaces import pressed_closure, rough_heights

#: Kernel and ratio of the sides of a cell.
CASES = [(kernel, 1.0) for kernel in ("love", *RIGID_PLATE_SELF_TERMS)] + [
    ("love", ratio) for ratio in (2.0, 8.0, 50.0)
]
#: Window on which the inverse is looked at, and the range of sides of the random scenes.
WINDOW = (12, 12)
SIDES = (4, 14)
RTOL = 1e-6
#: Tolerances of the inner solves whose effect is shown.
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
#: How near the made scene comes to where it would not be one.
_NEARLY = 0.9


def largest_off_diagonal(space):
    """Largest entry of K^-1 off its diagonal, as a share of the diagonal entry of its row.

    Parameters
    ----------
    space : HalfSpace

    Returns
    -------
    float
        Negative where elimination is always right; principal submatrices then share the property
        (T. L. Markham, Proc. Am. Math. Soc. 36 (1972) 326).
    """
    inverse, diagonal = _inverse(space)
    np.fill_diagonal(inverse, -np.inf)
    return float((inverse / diagonal[:, None]).max())


def counter_example(space, closure=1.0):
    """A topography on which the first step of elimination drops a point that is in contact.

    Parameters
    ----------
    space : HalfSpace
    closure : float
        mm.

    Returns
    -------
    (ny, nx) ndarray or None
        mm, to be pressed to ``closure``; None where the inverse has no positive entry.

    Notes
    -----
    All nodes but j are in contact under pressure 1, but i under less than M_ij g_j. The first step,
    which takes the gap g_j for closed, finds p_i - M_ij g_j < 0 there and drops i.
    """
    inverse, diagonal = _inverse(space)
    np.fill_diagonal(inverse, -np.inf)
    i, j = np.unravel_index((inverse / diagonal[:, None]).argmax(), inverse.shape)
    if not inverse[i, j] > 0:
        return None
    everywhere = np.ones(space.shape, bool)
    influence = influence_matrix(space, everywhere, everywhere)
    pressure = np.ones(len(influence))
    pressure[j] = 0.0
    # Node j stays among the interpenetrating ones, if only just.
    gap = _NEARLY * (influence[j] @ pressure)
    pressure[i] = _NEARLY * inverse[i, j] * gap
    interference = influence @ pressure
    interference[j] -= gap
    return (closure * interference / interference.max()).reshape(space.shape)


def elimination(draws=200):
    """How often the paper's algorithm ends on a wrong set, kernel by kernel.

    Parameters
    ----------
    draws : int
        Random rough scenes a case.

    Returns
    -------
    xr.Dataset
        On ``case``, with ``kernel`` and ``ratio`` of the sides of a cell: ``tried``, ``wrong``, the
        largest ``force_error`` of those; ``largest_off_diagonal``; ``counter_example``, whether one
        made on purpose defeats it. On ``tolerance``, with Love's kernel: the share of scenes that
        ``lost`` a node of the contact to an inexact solve, and the largest ``area_error`` of them.
    """
    rows = [_case(kernel, ratio, draws) for kernel, ratio in CASES]
    result = xr.Dataset(
        coords={
            "tolerance": ("tolerance", list(TOLERANCES), cf_attrs("1", "tolerance of the solves")),
            "case": [f"{kernel}, cells {ratio:g}:1" for kernel, ratio in CASES],
            "kernel": ("case", [kernel for kernel, _ in CASES]),
            "ratio": (
                "case",
                [ratio for _, ratio in CASES],
                cf_attrs("1", "ratio of a cell's sides"),
            ),
        },
        attrs={"rtol": RTOL, "window": WINDOW, "sides": SIDES},
    )
    labels = {
        "largest_off_diagonal": "largest entry of the inverse influence matrix off its diagonal",
        "tried": "random scenes tried",
        "wrong": "scenes on which a dropped point is left interpenetrating",
        "force_error": "largest relative error of the force of those",
        "counter_example": "1 where a scene made on purpose defeats it, 0 where none can be made",
    }
    for name, values in zip(labels, zip(*rows, strict=True), strict=True):
        result[name] = "case", np.array(values), cf_attrs("1", labels[name])
    lost, area_error = np.array([_inexact(tolerance, draws) for tolerance in TOLERANCES]).T
    result["lost"] = (
        "tolerance",
        lost,
        cf_attrs("1", "scenes that lose nodes of the contact, share"),
    )
    result["area_error"] = "tolerance", area_error, cf_attrs("1", "largest error of A_r, relative")
    return result


def _inexact(tolerance, draws):
    """Share of scenes that lose contact nodes to inexact solves, and the largest error of A_r."""
    errors = []
    for draw in range(draws):
        height, space, closure = _random_scene(draw, "love", 1.0)
        found = METHODS["paper"](height, space, closure=closure, rtol=tolerance)
        exact = METHODS["dense"](height, space, closure=closure)
        if (exact.in_contact & ~found.in_contact).any():
            errors.append(abs(found.area / exact.area - 1))
    return len(errors) / draws, max(errors, default=0.0)


def _random_scene(draw, kernel, ratio):
    """A rough surface, its half-space and a closure."""
    generator = np.random.default_rng(draw)
    shape = tuple(int(n) for n in generator.integers(*SIDES, size=2))
    height = rough_heights(generator, shape, generator.uniform(0.1, 0.9))
    closure = pressed_closure(height, generator.uniform(0.3, 1)) * generator.uniform(1, 6)
    return height, HalfSpace(shape, (ratio, 1.0), 1.0, kernel=kernel), closure


def _case(kernel, ratio, draws):
    wrong, worst = 0, 0.0
    for draw in range(draws):
        height, space, closure = _random_scene(draw, kernel, ratio)
        error = _error_of_elimination(height, space, closure)
        if error is not None:
            wrong, worst = wrong + 1, max(worst, error)
    space = HalfSpace(WINDOW, (ratio, 1.0), 1.0, kernel=kernel)
    made = counter_example(space)
    defeated = made is not None and _error_of_elimination(made, space, 1.0) is not None
    return largest_off_diagonal(space), draws, wrong, worst, int(defeated)


def _error_of_elimination(height, space, closure):
    """Relative error of the force where elimination ends on a wrong set; None where it is right."""
    try:
        METHODS["paper"](height, space, closure=closure, rtol=RTOL)
    except NotConverged as error:
        exact = METHODS["dense"](height, space, closure=closure)
        return abs(error.state.force / exact.force - 1)
    return None


def _inverse(space):
    everywhere = np.ones(space.shape, bool)
    inverse = np.linalg.inv(influence_matrix(space, everywhere, everywhere))
    return inverse, np.diag(inverse).copy()
