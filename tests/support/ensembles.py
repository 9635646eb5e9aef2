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
    # contact
    "candidate problems": (20, 1000),
    "random energies": (10, 60),
    "capped programmes": (20, 200),
    "hardness of each node": (3, 40),
    "paths between bounds": (4, 100),
    "side of a path between bounds": (18, 48),
    "cycles of random surfaces": (8, 200),
    "nodes across a sphere": (128, 512),
    "candidate problem side": (80, 200),
    # accuracy
    "random problems": (50, 300),
    "random problem side": (100, 400),
    "problems once given up": ((47,), (198, 47, 87, 1061)),
    "stability draws": (1, 2),
    "elimination draws": (4, 12),
    "placements": (2, 4),
    "extrapolations": (10, 30),
    "joints of known truth": ((8, 24), (40, 48)),
    # mechanics, size effect, experiments
    "fitted hyperbolas": (300, 1000),
    "calibrations": (4, 20),
    "side of a flat face": (64, 96),
    "joints whose size exponent is known": (200, 1000),
    "faces of one exponent": (4, 8),
    "surfaces of every exponent": (10, 20),
    "surfaces with many hills": ((256, 4), (512, 5)),
    "joints with a roll-off": (6, 8),
    "surfaces of every dimension": (2, 3),
    # flow
    "fields solved densely": (100, 400),
    "windows of one field": (60, 300),
    "finer grid of sampled fields": (240, 510),
    # domain
    "maps at random": (4, 100),
    "carpet sizes": ((81, 243, 500), (81, 200, 300, 400, 243, 256, 500, 512, 729, 1000)),
    "dust sizes": ((200, 243, 500), (200, 300, 400, 243, 256, 500, 512, 729, 1000)),
    "drawn dust sizes": ((256, 500), (243, 256, 500, 512, 729, 1000)),
    "drawn carpets": (((256, 6),), ((256, 7), (500, 7), (512, 7), (1000, 7))),
    "cut dust sizes": ((400, 550), (400, 500, 550, 600, 650)),
    "angles of drawn dusts": ((20,), (0, 20, 30, 45)),
    "percolation clusters": (((256, 8),), ((512, 8), (1024, 8))),
    "random cascades": (((1.5, 12),), ((1.2, 20), (1.5, 20), (1.8, 20))),
    "pair percolation clusters": ((256, 6), (512, 6)),
    "random domains": (60, 200),
    "thinned domains": (25, 100),
    "random domains compared": (200, 1000),
    "pairs of cuts": (200, 600),
    "worlds of cuts": (
        (((64, 64), 0.8, 16, 0.2, 100),),
        (
            ((64, 64), 0.8, 16, 0.2, 100),
            ((128, 128), 0.8, 32, 0.5, 500),
            ((128, 128), 0.5, None, 0.3, 400),
            ((192, 96), 0.5, None, 0.2, 300),
            ((200, 200), 0.8, 50, 0.2, 300),
        ),
    ),
    "fractals beside nulls": (1, 6),
    "sets of power-law sizes": (60, 200),
    # surface
    "synthetic seeds": (8, 20),
    "uneven surfaces": (16, 64),
    "faces like fractured rock": (3, 12),
    "edge pairs": (20, 40),
    "outlier surfaces": ((200, (1, 2)), (400, (1, 2))),
    "extruded profiles": ((512, 8), (1024, 10)),
    "surfaces of other makers": (4, 10),
    # roughness
    "surfaces of known H": (6, 12),
    "surfaces with a roll-off": (2, 6),
    "slopes of surfaces": (6, 16),
    "intervals of surfaces": (6, 20),
    "noisy surfaces": (1, 3),
    "axes of spectra": ("x", "xy"),
    "exponents of spectra": ((0.3, 0.8), (0.3, 0.5, 0.8, 0.9)),
    # scan
    "spoilt scan files": (44, 300),
    "files of every dialect": (1, 6),
    "drafted files": (150, 400),
    "sound scan files": (("npy", "stl", "x3p", "nc"), None),
    "scattered points": (2500, 6000),
    "registered pairs": (4, 20),
    # core
    "damages to kernels": (("cut in half", "one bit"), None),
    "processes that compile": (3, 6),
    "threads": (3, 8),
    "sides solved by threads": ((48, 96), (48, 200, 400)),
    "side solved in forks": (128, 400),
    "forks": (4, 10),
    # Of `make faults`, whose option --quick takes the first. Damage: 0 is every kind of file alone,
    # and all of them at once in every way.
    "faults: kills": (3, 50),
    "faults: damage": (4, 0),
    "faults: scans": (3, 12),
    "faults: scans meanwhile": (1, 10),
    "faults: scans ahead": (1, 3),
    "faults: stops": (1, 6),
    "faults: full disks": (1, 6),
    "faults: two runs": (1, 4),
    "faults: threads": (1, 10),
    "faults: forks": (1, 10),
    "faults: interrupts": (20, 300),
    "faults: kernels": (2, 12),
    "faults: held": (2, 6),
    # Figures of accuracy: nodes per side, and Hurst exponents, of their test problems.
    "accuracy_figure_sizes": ([12, 16], [16, 24, 32]),
    "accuracy_figure_hurst": ([0.8], [0.5, 0.8]),
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
