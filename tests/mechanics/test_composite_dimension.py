"""Dimension of the composite topography: from lags below the offset, or none."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.mechanics.composite_dimension import composite_dimensions
from fractalcontact.mechanics.joint import composite_topography
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SPACING, HURST = 0.1, 0.8


def specimen(opposite="match"):
    heights = self_affine((320, 320), SPACING, HURST, seed=5, rms=0.3)
    coords = {axis: np.arange(320) * SPACING for axis in "yx"}
    attrs = {"spacing_x": SPACING, "spacing_y": SPACING}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    return make_specimen(scan, window=12.8, name="test", opposite=opposite)


def measured(joint, cells, stated=None, direction="E"):
    composites = [composite_topography(joint, direction, n) for n in cells]
    variables = composite_dimensions(joint, composites, np.array(cells) * SPACING, stated)
    return xr.Dataset({name.removeprefix("composite_"): of for name, of in variables.items()})


@pytest.fixture(scope="module")
def slid():
    return measured(specimen(), [0, 3, 9, 10, 24, 64])


def test_below_the_offset_it_is_the_dimension_of_the_face(slid):
    known = slid.isel(offset=slice(3, None))
    assert (known["dimension_low"] < 3 - HURST).all()
    assert (known["dimension_high"] > 3 - HURST).all()
    np.testing.assert_allclose(known["dimension"], 3 - HURST, atol=0.1)
    assert (known["no_dimension"] == "").all()
    # No trend with the offset, which a fit across it would have found.
    assert known["dimension"].max() - known["dimension"].min() < 0.1


def test_short_offsets_are_undetermined(slid):
    unknown = slid.isel(offset=slice(0, 3))
    assert unknown["dimension"].isnull().all()
    assert unknown["fit_max"].isnull().all()
    assert (unknown["no_dimension"] == "undetermined: v below 10 cells").all()


def test_lags_end_at_half_the_offset(slid):
    cells = np.array([10, 24])
    assert (slid["fit_max"][3:5] <= cells / 2 * SPACING + 1e-9).all()
    assert (slid["fit_max"][3:5] > 0.8 * cells / 2 * SPACING).all()


def test_a_fit_across_the_offset_finds_a_flat_surface():
    joint = specimen()
    flat = measured(specimen("flat"), [0], direction="none")
    assert flat["dimension"].item() == pytest.approx(3 - HURST, abs=0.1)
    joint.attrs["opposite"] = "scanned"  # taken as two faces, whose own range is used
    joint["upper"] = joint["lower"].copy()
    across = measured(joint, [3], stated=(0.4, 1.6))
    assert across["dimension"].item() > 2.5
