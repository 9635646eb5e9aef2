"""Specimens and groups of them compared: means, intervals and errors of known numbers."""

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from fractalcontact.statements.comparison import (
    COMPARED_QUANTITIES,
    UNDER_LOAD,
    _dilatancy,
    compare_specimens,
    compared_pressures,
    rounded_pressures,
)

PRESSURES = [0.1, 1.0, 10.0]


def row(value, half_width, group, pressures=PRESSURES):
    """A row whose quantities are all the same."""
    variables = {"nominal_pressure": ("load", np.array(pressures, float))}
    for name in COMPARED_QUANTITIES:
        dims = ("load",) if name in UNDER_LOAD else ()
        shape = (len(pressures),) if dims else ()
        for end, sign in (("", 0), ("_low", -1), ("_high", 1)):
            variables[name + end] = (
                dims,
                np.full(shape, value + sign * half_width if sign else value),
            )
    return xr.Dataset(variables, attrs={"group": group, "label": "a twin"})


def test_a_group_has_the_mean_of_its_specimens_and_its_student_interval():
    values = [2.1, 2.2, 2.6, 2.3]
    compared = compare_specimens({f"s{i}": row(v, 0.1, "rough") for i, v in enumerate(values)})
    low, high = stats.t.interval(0.95, 3, np.mean(values), stats.sem(values))
    one = compared.isel(group_name=0)
    for name in COMPARED_QUANTITIES:
        assert np.allclose(one[f"{name}_mean"], np.mean(values))
        assert np.allclose(one[f"{name}_mean_low"], low)
        assert np.allclose(one[f"{name}_mean_high"], high)
        assert np.allclose(one[f"{name}_deviation"], np.std(values, ddof=1))
        assert np.allclose(one[f"{name}_error"], 0.1)
        assert (one[f"{name}_n"] == 4).all()


def test_groups_are_apart_and_one_specimen_has_no_interval():
    rows = {"a": row(1.0, 0.1, "x"), "b": row(3.0, 0.3, "x"), "c": row(9.0, 0.5, "y")}
    compared = compare_specimens(rows)
    assert compared["group_name"].values.tolist() == ["x", "y"]
    assert compared["delta_g_mean"].values.tolist() == [2.0, 9.0]
    assert np.isnan(compared["delta_g_mean_low"].sel(group_name="y"))
    assert np.isfinite(compared["delta_g_mean_low"].sel(group_name="x"))
    assert compared["group"].values.tolist() == ["x", "x", "y"]


def test_specimens_are_compared_under_one_pressure_alone():
    rows = {
        "a": row(1.0, 0.1, "x", [0.1, 1.0]),
        "b": row(3.0, 0.1, "x", [1.00001, 5.0, 7.0]),
    }
    compared = compare_specimens(rows)
    assert np.allclose(compared["pressure"], [0.1, 1.0, 5.0, 7.0])
    assert compared["stiffness_n"].values.tolist() == [[1, 2, 1, 1]]
    assert np.allclose(compared["stiffness_mean"], [[1, 2, 3, 3]])
    assert np.isnan(compared["stiffness"].sel(specimen="a").values[2:]).all()


def test_missing_values_count_nowhere():
    rows = {"a": row(1.0, 0.1, "x"), "b": row(np.nan, np.nan, "x"), "c": row(2.0, np.nan, "x")}
    one = compare_specimens(rows).isel(group_name=0)
    assert float(one["delta_g_mean"]) == 1.5
    assert int(one["delta_g_n"]) == 2
    assert float(one["delta_g_error"]) == pytest.approx(0.1)


def test_dilatancy_is_that_at_the_largest_offset_and_of_nothing_that_does_not_slide():
    opened = np.array([[[0.0, 0.0], [0.1, 0.05], [0.3, 0.2]]])
    dims = ("contact_direction", "offset", "normal_force")
    dilatancy = xr.Dataset(
        {
            "elastic_dilatancy": (dims, opened),
            "elastic_dilatancy_error": (dims, opened / 10),
            "left_out_error": (dims, np.where(opened > 0.25, np.nan, 0.1)),
        },
        coords={"contact_direction": ["E"], "offset": [0.0, 0.5, 2.0]},
    )
    found = _dilatancy(dilatancy, "E", 2)
    np.testing.assert_allclose(found["dilatancy"], [0.3, 0.2])
    np.testing.assert_allclose(found["dilatancy_high"], [0.33, 0.32])
    np.testing.assert_allclose(found["dilatancy_low"], [0.27, 0.08])
    assert np.isnan(_dilatancy(dilatancy, "none", 2)["dilatancy"]).all()


def test_order_of_the_specimens_changes_nothing():
    rows = {f"s{i}": row(v, 0.1, "g") for i, v in enumerate([2.0, 2.4, 2.1])}
    backwards = dict(reversed(list(rows.items())))
    assert compare_specimens(rows).identical(compare_specimens(backwards))


def test_pressures_that_differ_little_are_one_but_never_two_of_one_specimen():
    compared = compared_pressures([[1.0, 1.02, 5.0], [1.03, 5.2, np.nan], [2.0, 5.3, 9.0]])
    assert np.allclose(compared[0], [1.0, 1.025, 5.1])
    assert np.allclose(compared[1, :2], [1.025, 5.1])
    assert np.isnan(compared[1, 2])
    assert np.allclose(compared[2], [2.0, 5.3, 9.0])  # 5.3 is more than 5 % above 5.0


def test_pressures_are_rounded_to_four_digits():
    assert np.allclose(rounded_pressures([0.0012344, 12.3449, 99999.0]), [0.001234, 12.34, 1e5])
