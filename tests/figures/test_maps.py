"""Maps true to scale on cells and windows that are not square."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from fractalcontact.core.text import length_unit
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.figures.kit.maps import draw_map, node_position, window_outline


@pytest.mark.parametrize("sides", [(3.0, 8.0), (8.0, 3.0), (4e-3, 1e-3)])
@pytest.mark.parametrize("shape", [(6, 4), (3, 9)])
def test_every_node_is_drawn_at_its_place(shape, sides):
    values = np.arange(np.prod(shape), dtype=float).reshape(shape)
    with print_style():
        axes = Figure().subplots()
        image = draw_map(axes, values, sides)
        _, size = length_unit(max(sides))
        assert axes.get_xlim() == pytest.approx((0, sides[1] / size))
        assert sorted(axes.get_ylim()) == pytest.approx((0, sides[0] / size))
        for node in np.ndindex(shape):
            y, x = node_position(node, shape, sides)
            place = axes.transData.transform((x, y))
            event = SimpleNamespace(x=place[0], y=place[1])
            assert image.get_cursor_data(event) == values[node]


def test_the_outline_of_a_window_surrounds_its_cells_wherever_it_slides():
    attrs = {"spacing_y": 0.5, "spacing_x": 0.2}
    attrs |= {"window_y0": 4, "window_ny": 10, "window_x0": 15, "window_nx": 30}
    specimen = xr.Dataset(attrs=attrs)
    for slid in ((0.0, 0.0), (1.5, 0.0), (0.0, -0.6)):
        found = window_outline(specimen, 1e-3, slid)
        assert found.get_xy() == pytest.approx((1e3 * (3.0 + slid[1]), 1e3 * (2.0 + slid[0])))
        assert (found.get_width(), found.get_height()) == pytest.approx((6e3, 5e3))
