"""Quantities of load curves from a function of one curve."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.per_curve import per_curve, stacked

DIRECTIONS, OFFSETS, LOADS = ["E", "N", "W"], [0.1, 0.2], [1.0, 2.0, 4.0, 8.0]
NAMES = {
    "largest": ("mm", "largest closure"),
    "place": ("1", "curve"),
    "softened": ("1", "whether the curve is softer at its end"),
    "stiffness": ("MPa/mm", "initial stiffness"),
    "doubled": ("mm", "closure twice as large", "normal_force"),
}


def curves():
    """Closures of six curves, and what belongs to each of them or to all."""
    closure = np.random.default_rng(1).random((4, 2, 3))
    return xr.Dataset(
        {
            "closure": (("normal_force", "offset", "direction"), closure),
            "seat": (("offset", "direction"), closure[0]),
            "pressure": ("normal_force", LOADS),
            "modulus": 3.0,
        },
        {"direction": DIRECTIONS, "offset": OFFSETS, "normal_force": LOADS},
    )


def of_one(closure, seat, pressure, modulus):
    assert closure.shape == pressure.shape == (4,)
    assert (seat, modulus) == (closure[0], 3)
    return {
        "largest": closure.max(),
        "place": f"{closure[0]:.6f}",
        "softened": closure[-1] > closure[-2],
        "stiffness": Estimate(seat, seat - 1, seat + pressure[1]),
        "doubled": 2 * closure,
    }


def test_a_function_of_one_curve_gives_the_variables_of_all():
    data = curves()
    result = xr.Dataset(per_curve(data, of_one, NAMES), data.coords)
    over = ("offset", "direction")
    closure = data["closure"].transpose(*over, "normal_force").values
    assert result["largest"].dims == result["place"].dims == over
    np.testing.assert_array_equal(result["largest"], closure.max(axis=-1))
    np.testing.assert_array_equal(result["place"], np.vectorize("{:.6f}".format)(closure[..., 0]))
    np.testing.assert_array_equal(result["softened"], closure[..., 3] > closure[..., 2])
    assert result["softened"].dtype == bool
    assert result["doubled"].dims == (*over, "normal_force")
    np.testing.assert_array_equal(result["doubled"], 2 * closure)
    for name, apart in (("stiffness", 0), ("stiffness_low", -1), ("stiffness_high", 2)):
        np.testing.assert_array_equal(result[name], closure[..., 0] + apart)
        assert result[name].attrs["units"] == "MPa/mm"
    assert result["largest"].attrs == {"units": "mm", "long_name": "largest closure"}
    assert list(result) == [
        *("largest", "place", "softened", "stiffness", "stiffness_low", "stiffness_high"),
        "doubled",
    ]


def test_the_order_of_the_dimensions_of_a_curve_does_not_matter():
    data = curves()
    turned = data.assign(closure=data["closure"].transpose("direction", "normal_force", "offset"))
    turned = turned[["seat", "pressure", "closure", "modulus"]]
    xr.testing.assert_identical(
        xr.Dataset(per_curve(data, of_one, NAMES)), xr.Dataset(per_curve(turned, of_one, NAMES))
    )


def test_a_curve_may_have_several_dimensions():
    data = curves()[["closure"]]
    along = ("direction", "normal_force")

    def shape(closure):
        return {"rows": closure.shape[0], "first": closure[:, 0]}

    names = {"rows": ("1", "rows"), "first": ("mm", "first load", "direction")}
    result = xr.Dataset(per_curve(data, shape, names, along))
    np.testing.assert_array_equal(result["rows"], [3, 3])
    np.testing.assert_array_equal(result["first"], data["closure"].values[0])


def test_curves_at_different_places_are_refused():
    data = curves()
    moved = data["seat"].assign_coords(offset=[0.1, 0.3])
    with pytest.raises(ValueError, match="offset"):
        per_curve({"closure": data["closure"], "seat": moved}, dict, {})


def test_what_a_curve_lacks_is_missing():
    rows = [
        {"n": 3, "why": "flush", "sure": True, "of": Estimate(1, 0, 2), "counts": [1.0, 2.0, 3.0]},
        {"counts": [4.0]},
        {"n": 5, "counts": []},
    ]
    names = {
        **{name: ("1", name) for name in ("n", "why", "sure", "of")},
        "counts": ("1", "counts", "scale"),
    }
    result = xr.Dataset(stacked(rows, names, ["curve"]))
    np.testing.assert_array_equal(result["n"], [3, np.nan, 5])
    assert result["why"].values.tolist() == ["flush", "", ""]
    assert result["sure"].values.tolist() == [True, False, False]
    np.testing.assert_array_equal(result["of_high"], [2, np.nan, np.nan])
    expected = [[1, 2, 3], [4, np.nan, np.nan], [np.nan] * 3]
    np.testing.assert_array_equal(result["counts"], expected)
    assert result["counts"].dims == ("curve", "scale")


def test_arrays_without_a_value_leave_a_dimension_of_no_length():
    rows = [{"n": 1, "counts": [], "of": Estimate([], [], [])} for _ in range(2)]
    names = {"n": ("1", "n"), "counts": ("1", "counts", "scale"), "of": ("1", "of", "scale")}
    assert xr.Dataset(stacked(rows, names, ["curve"])).sizes == {"curve": 2, "scale": 0}


@pytest.mark.parametrize("names", [{"n": ("1", "n")}, {**NAMES, "n": ("1", "n")}])
def test_a_name_without_a_result_or_words_is_refused(names):
    rows = [{"n": 1, "largest": 2.0}]
    with pytest.raises(KeyError, match="largest" if len(names) == 1 else "doubled"):
        stacked(rows, names, ["curve"])
