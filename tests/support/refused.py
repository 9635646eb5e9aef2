"""What users hand over that cannot be meant, with the sentence that refuses it."""

import numpy as np

SHAPE = (24, 30)
NAN = np.full(SHAPE, np.nan)
GRID = np.ones(SHAPE)


def masked(shape=SHAPE):
    """Zeros, two of them masked."""
    values = np.ma.array(np.zeros(shape))
    values[3, 4:6] = np.ma.masked
    return values


#: What is no array of real numbers, and the sentence that says so.
NO_NUMBERS = {
    "masked": (masked(), "2 masked cells"),
    "rows masked": (list(masked()), "2 masked cells"),
    "complex": (GRID + 0j, "of type complex128: expected real numbers"),
    "text": (GRID.astype(str), "of type <U32: expected real numbers"),
    "objects": (GRID.astype(object), "of type object: expected real numbers"),
    "truths": (GRID > 0, "of type bool: expected real numbers"),
    "no array": (None, "of type object: expected real numbers"),
    "ragged": ([[1.0, 2.0], [3.0]], "expected an array of numbers"),
}
#: Loads that are no numbers.
NO_LOADS = [
    ({"force": "1"}, "force '1': expected a plain number, in N"),
    ({"force": "1 kN"}, "force '1 kN': expected a plain number"),
    ({"force": True}, "force True: expected a plain number"),
    ({"force": 1 + 0j}, "force .*: expected a plain number"),
    ({"force": [1.0]}, r"force \[1\.0\]: expected a plain number"),
    ({"force": np.ma.masked}, "force masked: expected a plain number"),
    ({"force": 10**400}, "force inf: expected a finite number"),
    ({"closure": 10**400}, "closure inf: expected a finite number"),
    ({"closure": "0.1 mm"}, "closure '0.1 mm': expected a plain number, in mm"),
    ({"force": 1.0, "rtol": "1e-6"}, "rtol '1e-6': expected a plain number"),
    ({"force": 1.0, "rtol": True}, "rtol True: expected a plain number"),
    ({"force": 1.0, "rtol": 1e-6j}, "rtol .*: expected a plain number"),
    ({"force": 1.0, "hardness": "3"}, "hardness '3': expected a plain number, in MPa"),
    ({"force": 1.0, "hardness": True}, "hardness True: expected a plain number"),
    ({"closure": 1.0, "hardness": 5e-324}, "hardness 5e-324: expected > 0 MPa"),
]
#: Loads at which double precision ends.
BEYOND = [{"force": f} for f in (5e-324, 1e-303, 1e305)]
BEYOND += [{"closure": c} for c in (5e-324, 1e-310, 1e300, 1e308)]
