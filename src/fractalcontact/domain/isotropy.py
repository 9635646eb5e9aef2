"""Isotropy of a contact domain: how often contact has contact beside it, along and across sliding.

A domain that shrinks alike along both axes (isotropic scaling) has the same probability along both.
"""

import numpy as np

from ..core.estimate import Estimate, rows_of
from ..core.intervals import jackknife_error
from ..core.slope_of_sums import BLOCKS

#: Nodes between which contact is compared: neighbours touch for being of one hill.
LAG = 2

#: What is kept of every domain: name, unit, long name.
LAG_FIELDS = {
    name: words
    for way in ("along", "across")
    for name, words in rows_of(
        f"contact_at_lag_{way}",
        "1",
        f"P(contact {LAG} nodes {way} sliding | contact), along x and across y where nothing "
        "slides",
    ).items()
}


def contact_at_lag(domain: np.ndarray, direction: str) -> dict[str, float]:
    """Probability that a node has contact where another at a lag of `LAG` nodes has, by direction.

    Parameters
    ----------
    domain : (ny, nx) bool ndarray
        Nodes in contact.
    direction : str
        Where the upper block slides: E or W along x, N or S along y; anything else counts as x.

    Returns
    -------
    dict of str to float
        :data:`LAG_FIELDS`. Of nodes with a neighbour at that lag inside the window; the interval
        is the jackknife's over parts of the window. NaN without contact. Nodes at random have the
        fraction of the window in contact.
    """
    along = 0 if direction in ("N", "S") else 1
    found: dict[str, float] = {}
    for way, axis in (("along", along), ("across", 1 - along)):
        found |= _conditional(domain, axis, LAG).columns(f"contact_at_lag_{way}")
    return found


def _conditional(domain, axis, lag):
    """P(contact at the lag | contact) along one axis, both ways, with its interval."""
    domain = np.moveaxis(np.asarray(domain, bool), axis, 0)
    if domain.shape[0] <= lag:
        return Estimate()
    first, second = domain[:-lag], domain[lag:]
    sums = np.array([_by_part(first & second), (_by_part(first) + _by_part(second)) / 2])
    total = sums.sum(axis=1)
    if total[1] == 0:
        return Estimate()
    value = total[0] / total[1]
    left = total[:, np.newaxis] - sums[:, sums[1] > 0]
    with np.errstate(invalid="ignore"):
        error = jackknife_error(left[0] / left[1])
    return Estimate(value, max(value - error, 0.0), min(value + error, 1.0))


def _by_part(values):
    """Sums of a field over `BLOCKS` x `BLOCKS` parts, as a list."""
    for axis in (0, 1):
        n = values.shape[axis]
        starts = np.unique(np.arange(BLOCKS) * n // BLOCKS)
        values = np.add.reduceat(values, starts, axis=axis, dtype=np.int32)
    return values.ravel()
