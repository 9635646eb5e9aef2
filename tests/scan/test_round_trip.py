"""Heights written to a file come back: the same surface whatever the format."""

import json

import numpy as np
import pytest
from scan_writers import WRITERS, write
from stated import read_scan

#: Largest error in mm: what each format can hold of heights within 0.5 mm.
PRECISION = {
    ".csv": 1e-9,
    ".xyz": 1e-9,
    ".gwyddion.txt": 1e-9,
    ".stl": 1e-7,
    ".ply": 1e-7,
    ".obj": 1e-8,
    ".nc": 1e-6,
    ".classic.nc": 1e-6,
    ".tif": 1e-7,
}
EXACT = 1e-15
CASES = {
    "square cells": ((12, 15), 0.1, 0.1),
    "more rows, oblong cells": ((23, 11), 0.5, 0.2),
    "fine": ((9, 40), 0.002, 0.005),
}
REPRESENTATIVE = "more rows, oblong cells"


def surface(shape, dx):
    """Heights without any symmetry, with a hole of several cells and one at the rim."""
    y, x = np.indices(shape)
    rough = np.random.default_rng(7).uniform(-1, 1, shape)
    heights = dx * (0.3 * x / shape[1] + 0.9 * (y / shape[0]) ** 2 + 0.2 * rough)
    heights[2:4, 5:8] = heights[-3, 1] = heights[0, -1] = np.nan
    return heights


@pytest.mark.parametrize(
    ("shape", "dx", "dy"),
    [
        pytest.param(*case, id=name, marks=() if name == REPRESENTATIVE else pytest.mark.full)
        for name, case in CASES.items()
    ],
)
@pytest.mark.parametrize("ending", WRITERS)
def test_heights_holes_and_cells_come_back(tmp_path, ending, shape, dx, dy):
    heights = surface(shape, dx)
    path = tmp_path / f"rock{ending}"
    sidecar = write(path, heights, dx, dy)
    read = read_scan(path, sidecar)
    assert read.shape == shape
    np.testing.assert_array_equal(np.isnan(read), np.isnan(heights))
    np.testing.assert_allclose(read, heights, rtol=0, atol=PRECISION.get(ending, EXACT))
    assert read.attrs["spacing_x"] == pytest.approx(dx, rel=1e-6)
    assert read.attrs["spacing_y"] == pytest.approx(dy, rel=1e-6)
    assert (np.diff(read.x) > 0).all()
    assert (np.diff(read.y) > 0).all()
    json.dumps(read.attrs)  # provenance is stored as text, so nothing but plain values
    assert " / " in read.attrs["reader"] or ending in (".stl", ".ply", ".obj")
