"""Preconditioner: approximate inverse of the elastic operator on a contact set.

Sets of a few nodes are inverted exactly. Else it is the sparse inverse-Cholesky factor
(`inverse_cholesky`), and in larger windows the coarse correction (`coarse_correction`) of what that
gets wrong, which is smooth.
"""

import threading
import weakref

import numpy as np

from ..elastic.halfspace import HalfSpace
from ..kernel_cache import njit
from .coarse_correction import CoarseCorrection
from .dense import inverted, times
from .inverse_cholesky import (
    NARROW_NEIGHBOURHOOD,
    WIDE_NEIGHBOURHOOD,
    InverseCholesky,
    influence_between,
)
from .node_sets import check_nodes, check_on_set

#: Sets of at most this many nodes are inverted exactly.
DIRECT = 96
#: Windows of at most this many cells along the longer side do without the coarse correction too.
SMALL = 160
#: Sets of at most this many nodes among few candidates do without it too: they are scattered, and
#: what their nodes add up to is no smooth pressure. It would cost more applications than it saves.
SCATTERED = 10_000


class Preconditioner:
    """Symmetric positive definite approximation to the inverse of K on a contact set.

    Attributes
    ----------
    small : bool
        Whether the window is one of those in which applications cost little beside the rest.

    Notes
    -----
    ``update`` keeps of the factor what a new set leaves unchanged, bit for bit as a fresh start
    would have it. The coarse operator lags behind the set, by up to `coarse_correction.LAG`,
    unless it is made ``fresh``. An update changes the object, so that no two threads may use one:
    `preconditioner` gives each its own.
    """

    def __init__(self, space: HalfSpace):
        self.small = max(space.shape) <= SMALL
        self._shape, self._has_null_space = space.shape, not space.is_free
        neighbourhood = NARROW_NEIGHBOURHOOD if self.small else WIDE_NEIGHBOURHOOD
        self._factor = InverseCholesky(space, neighbourhood)
        # Not held: what is kept for a half-space would keep it.
        self._space = weakref.ref(space)
        self._coarse: CoarseCorrection | None = None
        self._exact: np.ndarray | None = None
        self._local = self.small

    def update(self, nodes: np.ndarray, *, fresh: bool, scattered: bool = False) -> None:
        """Make this the inverse on another contact set.

        Parameters
        ----------
        nodes : (n,) int32 ndarray
            Its nodes as numbers of cells, ascending.
        fresh : bool
            Whether to make the coarse operator anew, which else may lag a little behind the set.
        scattered : bool
            Whether the set is among few candidates in a large window: see `SCATTERED`.

        Raises
        ------
        ValueError
            If they are no such numbers.
        """
        check_nodes(nodes, self._shape)
        self._exact = None
        if fresh and self._coarse is not None:
            # Also where so few nodes come first that none is needed yet.
            self._coarse.forget()
        if nodes.size <= DIRECT:
            # Few nodes of a large window may lie further apart than the table reaches.
            singular = self._has_null_space and nodes.size == self._shape[0] * self._shape[1]
            self._exact = _exact_inverse(nodes, self._shape[1], self._factor.anywhere, singular)
            return
        self._factor.update(nodes)
        self._local = self.small or (scattered and nodes.size <= SCATTERED)
        if not self._local:
            if self._coarse is None:
                self._coarse = self._new_coarse_correction()
            self._coarse.update(nodes, fresh)

    def _new_coarse_correction(self):
        space = self._space()
        if space is None:
            raise ReferenceError("the half-space of this preconditioner is gone")
        return CoarseCorrection(space)

    def __call__(self, residual: np.ndarray) -> np.ndarray:
        """The approximate solution x of K x = residual, both (n,) float32 on the contact set.

        Raises
        ------
        ValueError
            If the residual is not one on the set of the last update.
        """
        if self._exact is not None:
            check_on_set(residual, len(self._exact))
            return times(self._exact, residual)
        if self._local or self._coarse is None:
            return self._factor(residual)
        check_on_set(residual, self._factor.size)
        return self._coarse.balance(residual, self._factor)


class _Preconditioners(dict):
    """By the id of a half-space: a weak reference to it, and its preconditioner."""


class _ThreadStore(threading.local):
    """The preconditioners that this thread keeps; they end with the thread."""

    def __init__(self):
        self.kept = _Preconditioners()


_THREAD = _ThreadStore()


def preconditioner(space: HalfSpace) -> Preconditioner:
    """The preconditioner that this thread keeps for a half-space.

    It is kept as the next contact set is much the same, and as long as the half-space itself and
    the thread. After ``update(fresh=True)`` it does not depend on the sets it was of before.

    Parameters
    ----------
    space : HalfSpace
        This very object, not one equal to it.
    """
    kept, key = _THREAD.kept, id(space)
    of, inverse = kept.get(key, (None, None))
    if of is None or of() is not space:
        # The dictionary is not held by what it holds: neither would ever end.
        mine, inverse = weakref.ref(kept), Preconditioner(space)
        kept[key] = weakref.ref(space, lambda _: _drop(mine(), key)), inverse
    return inverse


def forget_preconditioner(space: HalfSpace) -> None:
    """Drop this thread's cache for a half-space, to save memory or to start anew."""
    _drop(_THREAD.kept, id(space))


def _drop(kept, key):
    if kept is not None:
        kept.pop(key, None)


@njit(cache=True)
def _exact_inverse(nodes, nx, influence, singular):
    """Inverse of K on a few nodes, exactly; where it has none, for pressures of the mean zero."""
    n = nodes.size
    everywhere = float(influence[0][0, 0]) if singular else 0.0
    inverse = np.empty((n, n))
    for a in range(n):
        for b in range(n):
            dy = abs(nodes[a] // nx - nodes[b] // nx)
            inverse[a, b] = influence_between(influence, dy, abs(nodes[a] % nx - nodes[b] % nx))
            inverse[a, b] += everywhere
    return inverted(inverse).astype(np.float32)
