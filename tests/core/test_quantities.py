"""The register of shown quantities: each is in the atlas, and is shown where it says."""

import numpy as np
import xarray as xr

from fractalcontact.core.quantities import Shown, bounds_of, shown_in, shown_quantities
from fractalcontact.core.subject import Subject


def subject(**closure):
    """A specimen with one direction, offset and resolution, and three loads."""
    dims = ("direction", "offset", "resolution", "normal_force")
    stage = xr.Dataset(
        {
            **{
                name: (dims, np.reshape(values, (1, 1, 1, 3)), {"units": "mm"})
                for name, values in closure.items()
            },
            "reported_direction": "W",
            "reported_offset": 0.1,
            "reported_resolution": 1,
            "reported_load": ("normal_force", [True, True, True]),
            "reference_load": ("normal_force", [False, True, False]),
        },
        coords={
            "direction": ["W"],
            "offset": [0.1],
            "resolution": [1],
            "normal_force": [1.0, 2.0, 3.0],
        },
    )
    return Subject({"closure": stage}, {})


def test_a_line_is_all_that_a_quantity_needs_to_have_a_column():
    of = Shown("closure/width", summary="width", page="width of contact")
    alone = of.at(subject(width=[1, 2, 3]), 1)
    assert alone.columns("width") == {"width_mm": 2}
    assert not alone.has_interval
    ends = {"width": [1, 2, 3], "width_low": [0, 1, 2], "width_high": [2, np.nan, 4]}
    found = of.at(subject(**ends), 1).columns("width")
    # Columns depend on what the stage has, never on whether a value is known.
    assert list(found) == ["width_mm", "width_low_mm", "width_high_mm"]
    assert np.isnan(found["width_high_mm"])


def test_each_stands_once_and_names_what_it_is_shown_as():
    keys = [one.key for one in shown_quantities()]
    assert len(keys) == len(set(keys)) > 15
    columns = [one.summary for one in shown_quantities() if one.summary]
    assert len(columns) == len(set(columns)) > 0
    assert [one.page for one in shown_quantities() if one.page]


def test_a_place_lists_what_it_shows_in_the_order_of_the_register():
    order = [one.key for one in shown_quantities()]
    for place in ("summary", "page", "index"):
        keys = [one.key for one in shown_in(place)]
        assert keys == sorted(keys, key=order.index)
        assert keys
    assert set(shown_in("page", "index")) == {*shown_in("page"), *shown_in("index")}


def test_a_quantity_has_the_bounds_of_its_kind():
    assert bounds_of("mean_gap") == bounds_of("interface_stiffness") == (0, np.inf)
    assert bounds_of("delta_sigma") == bounds_of("delta_sigma_area") == (0, 2)
    # Faces that are pressed into each other have a separation below zero.
    assert bounds_of("separation") == bounds_of("of no register") == (-np.inf, np.inf)
