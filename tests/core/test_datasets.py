"""Datasets made from a table of dimensions, units and long names."""

import numpy as np
import pytest

from fractalcontact.core.datasets import labelled, labelled_dataset

TABLE = {
    "height": (("y", "x"), "mm", "height above the mean plane"),
    "load": ("load", "MPa", "nominal pressure"),
    "force": ((), "N", "force"),
}
VALUES = {"load": [1.0, 2.0], "force": 3.0, "height": np.zeros((2, 5))}


def test_each_variable_has_the_dimensions_and_the_words_of_the_table():
    coords = {"x": np.arange(5.0)}
    dataset = labelled_dataset(TABLE, VALUES, coords=coords, attrs={"specimen": "granite"})
    dims = {name: dataset[name].dims for name in TABLE}
    assert dims == {"height": ("y", "x"), "load": ("load",), "force": ()}
    np.testing.assert_array_equal(dataset.x, coords["x"])
    assert dataset.height.attrs == {"units": "mm", "long_name": "height above the mean plane"}
    assert float(dataset.force) == 3
    assert dataset.sizes == {"y": 2, "x": 5, "load": 2}
    assert dataset.attrs == {"specimen": "granite"}


def test_variables_come_in_the_order_of_the_table():
    assert list(labelled(TABLE, VALUES)) == list(TABLE)


@pytest.mark.parametrize(
    ("table", "values"),
    [
        (TABLE, {**VALUES, "more": 1}),
        (TABLE, {"height": VALUES["height"], "load": VALUES["load"]}),
    ],
)
def test_a_name_that_is_missing_on_either_side_is_refused(table, values):
    with pytest.raises(KeyError, match="more" if "more" in values else "force"):
        labelled(table, values)
