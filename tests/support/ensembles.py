"""How many seeds, draws and sizes the tests take: one place for both suites.

``make test`` takes the first number of each, a representative; ``make test-all`` the second.
"""

import os

#: Whether everything is tested, said by ``make test-all``.
EVERYTHING = os.environ.get("TESTS") == "all"

#: Ensemble: (for ``make test``, for ``make test-all``).
ENSEMBLES: dict[str, tuple] = {
    # scan
    "spoilt scan files": (44, 300),
    "sound scan files": (("npy", "stl", "x3p", "nc"), None),
    "scattered points": (2500, 6000),
    # core
    "damages to kernels": (("cut in half", "one bit"), None),
    "processes that compile": (3, 6),
    "threads": (3, 8),
    "sides solved by threads": ((48, 96), (48, 200, 400)),
    "side solved in forks": (128, 400),
    "forks": (4, 10),
}


def ensemble(name):
    """The number, or the tuple of sizes, of an ensemble in the suite that runs."""
    quick, full = ENSEMBLES[name]
    return full if EVERYTHING else quick
