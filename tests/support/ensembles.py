"""How many seeds, draws and sizes the tests take: one place for both suites.

``make test`` takes the first number of each, a representative; ``make test-all`` the second.
"""

import os

#: Whether everything is tested, said by ``make test-all``.
EVERYTHING = os.environ.get("TESTS") == "all"

#: Ensemble: (for ``make test``, for ``make test-all``).
ENSEMBLES: dict[str, tuple] = {
    # mechanics, size effect, experiments
    "fitted hyperbolas": (300, 1000),
    "side of a flat face": (64, 96),
    "faces of one exponent": (4, 8),
    "surfaces of every exponent": (10, 20),
    "surfaces with many hills": ((256, 4), (512, 5)),
    "joints with a roll-off": (6, 8),
    "surfaces of every dimension": (2, 3),
}


def ensemble(name):
    """The number, or the tuple of sizes, of an ensemble in the suite that runs."""
    quick, full = ENSEMBLES[name]
    return full if EVERYTHING else quick
