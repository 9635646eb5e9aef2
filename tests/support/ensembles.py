"""How many seeds, draws and sizes the tests take: one place for both suites.

``make test`` takes the first number of each, a representative; ``make test-all`` the second.
"""

import os

#: Whether everything is tested, said by ``make test-all``.
EVERYTHING = os.environ.get("TESTS") == "all"

#: Ensemble: (for ``make test``, for ``make test-all``).
ENSEMBLES: dict[str, tuple] = {
    # Shapes, spacings and contact fractions on which the preconditioner's spectrum is computed.
    "contact sets": (
        [
            ((60, 60), (1.0, 1.0), 0.1),
            ((180, 170), (1.0, 1.0), 0.015),
            ((20, 180), (1.0, 1.0), 0.15),
            ((64, 64), (0.25, 2.0), 0.1),
            ((22, 22), (1.0, 1.0), 1.0),
        ],
        [
            ((60, 60), (1.0, 1.0), 0.2),
            ((180, 170), (1.0, 1.0), 0.05),
            ((31, 200), (1.0, 1.0), 0.3),
            ((64, 64), (0.25, 2.0), 0.2),
            ((40, 40), (1.0, 1.0), 1.0),
        ],
    ),
    # Cells across the contact radius at which errors of exact solutions are fitted.
    "cells across the radius": ((5, 8, 12, 20), (5, 8, 12, 20, 32)),
}


def ensemble(name):
    """The number, or the tuple of sizes, of an ensemble in the suite that runs."""
    quick, full = ENSEMBLES[name]
    return full if EVERYTHING else quick
