"""Preconditioner: approximate inverse of the elastic operator on a contact set.

Sets of a few nodes are inverted exactly. Otherwise it is the sparse inverse-Cholesky factor
(`inverse_cholesky`) and, in larger windows, the coarse correction (`coarse_correction`) of the
factor's error, which is smooth.
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

#: Most nodes of a set that is inverted exactly.
DIRECT = 96
#: Most cells along the longer side of a window without coarse correction.
SMALL = 160
#: Most nodes of a set among few candidates without coarse correction: they are scattered, and their
#: pressure is not smooth. The correction would cost more applications than it saves.
SCATTERED = 10_000


class Preconditioner:
    """Symmetric positive definite approximation to the inverse of K on a contact set.

    ``small`` is True for windows in which applications cost little beside the rest. ``update``
    keeps the part of the factor that a new set leaves unchanged, identical to the bit to a fresh
    start. The coarse operator may lag behind the set, by up to `coarse_correction.LAG`, unless it
    is ``fresh``. An update changes the object, so that no two threads may share one:
    `preconditioner` gives each its own.
    """

    def __init__(self, space: HalfSpace):
        self.small = max(space.shape) <= SMALL
        self._shape, self._has_null_space = space.shape, not space.is_free
        neighbourhood = NARROW_NEIGHBOURHOOD if self.small else WIDE_NEIGHBOURHOOD
        self._factor = InverseCholesky(space, neighbourhood)
        # A weak reference: the cache of a half-space must not keep it alive.
        self._space = weakref.ref(space)
        self._coarse: CoarseCorrection | None = None
        self._exact: np.ndarray | None = None
        self._local = self.small

    def update(self, nodes: np.ndarray, *, fresh: bool, scattered: bool = False) -> None:
        """Move to another contact set, (n,) int32 ascending numbers of cells.

        ``fresh``: rebuild the coarse operator, which may otherwise lag a little behind the set.
        ``scattered``: the set is among few candidates in a large window, see `SCATTERED`.
        """
        check_nodes(nodes, self._shape)
        self._exact = None
        if fresh and self._coarse is not None:
            # The coarse correction is forgotten even before a set of few nodes, which does not need
            # it yet.
            self._coarse.forget()
        if nodes.size <= DIRECT:
            # The few nodes of a large window may be further apart than the table reaches.
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
        """Approximate solution x of K x = residual, both (n,) float32 on the contact set."""
        if self._exact is not None:
            check_on_set(residual, len(self._exact))
            return times(self._exact, residual)
        if self._local or self._coarse is None:
            return self._factor(residual)
        check_on_set(residual, self._factor.size)
        return self._coarse.balance(residual, self._factor)


class _Preconditioners(dict):
    """Weak reference to a half-space and its preconditioner, by the half-space's id."""


class _ThreadStore(threading.local):
    """Preconditioners cached by this thread; they end with it."""

    def __init__(self):
        self.kept = _Preconditioners()


_THREAD = _ThreadStore()


def preconditioner(space: HalfSpace) -> Preconditioner:
    """Preconditioner that this thread caches for a half-space (this object, not an equal one).

    It is kept because the next contact set is similar, and lives as long as the half-space and the
    thread. After ``update(fresh=True)`` it does not depend on earlier sets.
    """
    kept, key = _THREAD.kept, id(space)
    of, inverse = kept.get(key, (None, None))
    if of is None or of() is not space:
        # A weak reference: dictionary and half-space would otherwise keep each other alive.
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
    """Exact inverse of K on a few nodes; for pressures of mean 0 where K is singular."""
    n = nodes.size
    everywhere = float(influence[0][0, 0]) if singular else 0.0
    inverse = np.empty((n, n))
    for a in range(n):
        for b in range(n):
            dy = abs(nodes[a] // nx - nodes[b] // nx)
            inverse[a, b] = influence_between(influence, dy, abs(nodes[a] % nx - nodes[b] % nx))
            inverse[a, b] += everywhere
    return inverted(inverse).astype(np.float32)
