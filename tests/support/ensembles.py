"""How many seeds, draws and sizes the tests take: one place for both suites.

``make test`` takes the first number of each, a representative; ``make test-all`` the second.
"""

import os

#: Whether everything is tested, said by ``make test-all``.
EVERYTHING = os.environ.get("TESTS") == "all"

#: Ensemble: (for ``make test``, for ``make test-all``).
ENSEMBLES: dict[str, tuple] = {
    # Of `make faults`, whose option --quick takes the first. Damage: 0 is every kind of file alone,
    # and all of them at once in every way.
    "faults: kills": (3, 50),
    "faults: damage": (4, 0),
    "faults: scans": (3, 12),
    "faults: scans meanwhile": (1, 10),
    "faults: stops": (1, 6),
    "faults: full disks": (1, 6),
    "faults: two runs": (1, 4),
    "faults: threads": (1, 10),
    "faults: forks": (1, 10),
    "faults: interrupts": (20, 300),
    "faults: kernels": (2, 12),
}


def ensemble(name):
    """The number, or the tuple of sizes, of an ensemble in the suite that runs."""
    quick, full = ENSEMBLES[name]
    return full if EVERYTHING else quick
