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
}


def ensemble(name):
    """The number, or the tuple of sizes, of an ensemble in the suite that runs."""
    quick, full = ENSEMBLES[name]
    return full if EVERYTHING else quick
