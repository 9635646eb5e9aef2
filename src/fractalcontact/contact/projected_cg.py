"""Linear equations K x = b on a contact set, solved as far as the search for the set needs."""

import numpy as np

from ..core.kernel_cache import njit
from .preconditioner import preconditioner

# Applications in one solve: on an exact set about ten reach 1e-6.
MAX_INNER = 60
# Passes in search of the closure that gives a clipped step its total.
CLIPPING_PASSES = 20
# In it, least effect of closure on a node's pressure, as a share of the mean.
LEAST_SHARE = 1e-2
# Stiffness: its error is of second order in this residual.
TANGENT_RESIDUAL = 1e-4


class Operator:
    """K of one window with its preconditioner, and how often K was applied.

    Like that, it belongs to one thread.

    Parameters
    ----------
    space : HalfSpace
    """

    def __init__(self, space):
        self.space, self.inverse = space, preconditioner(space)
        self.applications = 0
        self._grid = np.zeros(space.shape, np.float32)

    def __call__(self, pressure):
        """Displacement of the whole grid, (n,), in the precision of the pressure, (n,)."""
        self.applications += 1
        return self.space.convolve(pressure.reshape(self.space.shape)).ravel()

    def on(self, *parts):
        """The same in single precision under (nodes, values) pairs alone.

        Raises
        ------
        ValueError
            If a pair does not go together, or lies outside the grid.
        """
        grid = self._grid.ravel()
        for nodes, values in parts:
            _put(grid, nodes, values)
        image = self(grid)
        for nodes, _ in parts:
            grid[nodes] = 0
        return image


class SetEquations:
    """K x = right side on a set, up to a common constant where the sum of x is given.

    The second is the change of closure that a given force leaves open (projected method of Gould,
    Hribar and Nocedal, SIAM J. Sci. Comput. 23 (2001) 1376).

    Parameters
    ----------
    operator : Operator
        Its inverse is that on the set.
    free : (n,) int ndarray
        Nodes of the set.
    right_side : (n,) ndarray

    Attributes
    ----------
    solution, residual : (n,) float32 ndarray
        x, and what is left of the right side.
    image : float32 ndarray
        K x on the whole grid.
    common : float
        The constant.
    inside : (n,) float32 ndarray
        0 at nodes that keep the x they have, whatever their equation says; else 1.
    at_zero, at_cap : (n,) bool ndarray
        Those that a clipped step took to a bound.

    Raises
    ------
    ValueError
        If the right side is not one on the set.
    """

    def __init__(self, operator, free, right_side):
        if right_side.shape != free.shape:
            raise ValueError(f"right side {right_side.shape}: expected {free.shape}")
        self.operator, self.free, self.inverse = operator, free, operator.inverse
        self.residual = right_side.astype(np.float32)
        self.solution = np.zeros(free.size, np.float32)
        self.image = np.zeros(operator.space.shape, np.float32).ravel()
        self.inside = np.ones(free.size, np.float32)
        self.at_zero = self.at_cap = np.zeros(free.size, bool)
        self.common = 0.0

    def clipped_step(self, start, bounds, total):
        """The approximate inverse's whole step, clipped so that start + x keeps within bounds.

        With a ``total``, start + x has that sum. What the step does is left to `carry_out`.

        Raises
        ------
        ValueError
            If the start is not one on the set.
        """
        if start.shape != self.free.shape:
            raise ValueError(f"start {start.shape}: expected {self.free.shape}")
        aim = start + self.inverse(self.residual)
        if total is not None and self.free.size:  # none is free where all that touches yields
            ones = self.inverse(np.ones(self.free.size, np.float32))
            common = _common_part(aim, ones, *bounds, total)
            self.residual += np.float32(common)
            self.common += common
        self.at_zero, self.at_cap = _clip(aim, start, *bounds, self.solution, self.inside)

    def carry_out(self, beyond, back):
        """The image of the step, and of ``back`` on the nodes ``beyond``, which goes with it."""
        self.image = self.operator.on((self.free, self.solution), (beyond, back))
        self.residual *= self.inside
        _take_off(self.residual, np.float32(1), self.image, self.free, self.inside)

    def conjugate_gradients(self, goal, *, by_force):
        """Go on until no residual exceeds ``goal``."""
        ones, give = self.inside, 0.0
        if by_force:
            ones = self.inverse(self.inside) * self.inside
            give = ones.sum(dtype=float)
            if give <= 0:
                return
        direction, previous = None, 1.0
        for _ in range(MAX_INNER):
            search = self.inverse(self.residual)
            offset, slope, worst = _projected(search, self.residual, self.inside, ones, give)
            self.common += offset
            if worst <= goal or slope <= 0:
                break
            if direction is None:
                direction = search
            else:
                direction *= np.float32(slope / previous)
                direction += search
            previous = slope
            image = self.operator.on((self.free, direction))
            along = _along(direction, image, self.free, self.inside)
            length = np.float32(slope / along)
            add(self.solution, length, direction)
            add(self.image, length, image)
            _take_off(self.residual, length, image, self.free, self.inside)


def stiffness(operator, free):
    """Sum of q with K q = 1 on some nodes: dF/dw of a state in which these lie between the bounds.

    Parameters
    ----------
    operator : Operator
    free : (n,) int32 ndarray

    Returns
    -------
    stiffness, error : float
        0 without nodes. ``error`` estimates the relative error, of second order in the
        residual of the equations.

    Notes
    -----
    For an approximate q with residual r = 1 - K q, sum(q) + r.q errs by r.K^-1 r only.
    """
    if free.size == 0:
        return 0.0, 0.0
    operator.inverse.update(free, fresh=True)
    equations = SetEquations(operator, free, np.ones(free.size))
    equations.conjugate_gradients(TANGENT_RESIDUAL, by_force=False)
    residual, q = equations.residual.astype(float), equations.solution.astype(float)
    value = q.sum() + residual @ q
    return value, float(residual @ operator.inverse(equations.residual)) / value


@njit(cache=True)
def add(values, scale, change):
    """values += scale * change, without arrays in between."""
    if values.size != change.size:
        raise ValueError("expected as many changes as values")
    for i in range(values.size):
        values[i] += scale * change[i]


@njit(cache=True)
def _put(values, places, those):
    """values[places] = those."""
    if places.size != those.size:
        raise ValueError("expected as many values as nodes")
    for i in range(places.size):
        if places[i] < 0 or places[i] >= values.size:
            raise ValueError("expected nodes of the grid")
        values[places[i]] = those[i]


# Sums are made in double precision, and without the threads of a library of linear algebra.


@njit(cache=True)
def _projected(search, residual, inside, ones, give):
    """Leave a search to the nodes inside; if ``ones`` give anything, make its sum zero by them.

    Returns
    -------
    offset : float
        What was added of ``ones``, and of 1 to the residual.
    slope, worst : float
        Search times residual, and the largest residual.
    """
    total, slope, worst = 0.0, 0.0, np.float32(0)
    for i in range(search.size):
        search[i] *= inside[i]
        total += search[i]
    offset = np.float32(-total / give) if give > 0 else np.float32(0)
    for i in range(search.size):
        search[i] += offset * ones[i]
        residual[i] += offset * inside[i]
        slope += search[i] * residual[i]
        worst = max(worst, abs(residual[i]))
    return float(offset), slope, worst


@njit(cache=True)
def _along(direction, image, free, inside):
    """Direction times its image, on the nodes inside."""
    total = 0.0
    for i in range(free.size):
        total += direction[i] * image[free[i]] * inside[i]
    return total


@njit(cache=True)
def _take_off(residual, scale, image, free, inside):
    """residual -= scale * image, on the nodes inside."""
    for i in range(free.size):
        residual[i] -= scale * image[free[i]] * inside[i]


@njit(cache=True)
def _common_part(aim, ones, low, high, total):
    """Move an aim along ``ones`` until it has a total when clipped; returns by how much of them."""
    n = aim.size
    # Where the approximation is not positive, as K^-1 1 is, more closure still means more.
    ones = np.maximum(ones.astype(np.float64), LEAST_SHARE * ones.mean())
    common, least, most = 0.0, -np.inf, np.inf
    for _ in range(CLIPPING_PASSES):
        missing, give = total, 0.0
        for i in range(n):
            end = aim[i] + common * ones[i]
            missing -= min(max(end, low), high)
            if low < end < high:
                give += ones[i]
        if abs(missing) <= 1e-7 * abs(total):
            break
        least, most = (common, most) if missing > 0 else (least, common)
        if give > 0:
            common += missing / give
        # Between two bounds Newton's step may go to where every node is at one of them.
        if not least < common < most:
            if np.isinf(most - least):
                break
            common = (least + most) / 2
    for i in range(n):
        aim[i] += common * ones[i]
    return common


@njit(cache=True)
def _clip(aim, start, low, high, step, inside):
    """The step to an aim between bounds; nodes that it takes to the lower and to the upper one."""
    at_low, at_high = np.empty(aim.size, np.bool_), np.empty(aim.size, np.bool_)
    for i in range(aim.size):
        end = min(max(aim[i], low), high)
        step[i] = end - start[i]
        at_low[i], at_high[i] = end <= low, end >= high
        if at_low[i] or at_high[i]:
            inside[i] = 0
    return at_low, at_high
