"""How many seeds, draws and sizes the tests take: one place for both suites.

``make test`` takes the first number of each, a representative; ``make test-all`` the second.
"""

import os

#: Whether everything is tested, said by ``make test-all``.
EVERYTHING = os.environ.get("TESTS") == "all"

#: Ensemble: (for ``make test``, for ``make test-all``).
ENSEMBLES: dict[str, tuple] = {
    # methods
    "dense problems": (3, 10),
    "dense side": (24, 48),
    "elimination side": (20, 32),
    "dropping side": (20, 40),
    "method problems": ((0, 2), (1, 5)),
    "warm start side": (20, 40),
    # accuracy
    "random problems": (50, 300),
    "random problem side": (100, 400),
    "problems once given up": ((47,), (198, 47, 87, 1061)),
    "stability draws": (1, 2),
    "elimination draws": (4, 12),
    "placements": (2, 4),
    "extrapolations": (10, 30),
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
