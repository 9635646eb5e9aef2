"""Few nodes of a large window, further apart than the table of the influence reaches."""

import numpy as np

from roughcontact.contact.inverse_cholesky import TABLE_SIDE
from roughcontact.contact.preconditioner import Preconditioner
from roughcontact.elastic.halfspace import HalfSpace


def test_their_inverse_is_exact():
    side = TABLE_SIDE + 200
    space = HalfSpace((side, side), (1.0, 1.0), 1.0)
    inverse = Preconditioner(space)
    nodes = np.array([0, 5, side - 1, side * (side // 2) + 9, side * side - 1], np.int32)
    inverse.update(nodes, fresh=True)
    y, x = np.divmod(nodes, side)
    influence = space.influence()[abs(y[:, np.newaxis] - y), abs(x[:, np.newaxis] - x)]
    load = np.arange(1, 6, dtype=np.float32)
    np.testing.assert_allclose(inverse(load), np.linalg.solve(influence, load), rtol=1e-5)
