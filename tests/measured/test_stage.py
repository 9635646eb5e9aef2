"""Variables of laboratory tests of one kind."""

import numpy as np
import pytest

from fractalcontact.core.settings import MeasuredTest
from fractalcontact.measured.curve import Curve
from fractalcontact.measured.others import NOTHING
from fractalcontact.measured.stage import _beside, _of_kind

READ = [Curve.of([0.1, 0.2, 0.3], [1, 2, 3], 0.1, log_x=False)]
READ += [Curve.of([0.1, 0.2], [1, 2], 0.1, log_x=False)]
COMPUTED = Curve.of([0.15, 0.25], [1, 2], 0.1, log_x=False)


def shear_test(direction):
    return MeasuredTest(
        kind="shear",
        file="shear.csv",
        columns={},
        branch="",
        cycle=0,
        way="",
        direction=direction,
        seat=np.nan,
        pressure=1.0,
        largest_pressure=np.nan,
        compliance=0.0,
        error=np.nan,
        calibrate="",
    )


@pytest.mark.parametrize("computed", [COMPUTED, NOTHING])
def test_a_test_without_a_computed_curve_has_its_readings_and_a_reason(computed):
    tests = [shear_test("E"), shear_test("W")]
    curves = zip(tests, READ, (computed, NOTHING), strict=True)
    rows = [_beside(*curve) | {"note": ""} for curve in curves]
    data = _of_kind("shear", tests, rows)
    points = max(computed.x.size, 1)
    assert data.sizes == {"shear_test": 2, "shear_reading": 3, "shear_point": points}
    np.testing.assert_array_equal(data["shear_read"], [[1, 2, 3], [1, 2, np.nan]])
    assert np.isnan(data["shear_ratio"][1]).all()
    assert np.isnan(data["shear_ratio_at_last"][1])
    assert (data["shear_reason"] == "").values.tolist() == [computed is COMPUTED, False]
    assert data["shear_at"].attrs["units"] == "mm"
    assert data["shear_test"].values.tolist() == ["E, 1 MPa", "W, 1 MPa"]
