"""Figure of the error budget."""

import numpy as np
import pytest
from cases import representative

from fractalcontact.core.text import force_unit
from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.joint.errors import SOURCES, TOTALS
from fractalcontact.figures.kit.drawing import print_style


@pytest.mark.parametrize("name", representative(["sliding", "flat", "pair"], 3))
def test_errors_drawn_are_those_of_the_budget(atlas, name):
    budget = atlas[f"error_budget/{name}"].to_dataset()
    with print_style():
        drawing = drawer_of("errors")(atlas, name)
    assert set(drawing.data["source"]) <= {*SOURCES, *TOTALS}
    for (quantity, source), rows in drawing.data.groupby(["quantity", "source"]):
        here = budget.sel(quantity=quantity)
        for column in ("error", "relative_error"):
            prefix = column.removesuffix("error")
            kept = (
                here[f"{prefix}{source}"] if source in TOTALS else here[column].sel(source=source)
            )
            np.testing.assert_array_equal(rows[column], kept)
    # What is not drawn at all is unknown or zero at every load.
    drawn = set(zip(drawing.data["quantity"], drawing.data["source"], strict=True))
    for quantity in budget["quantity"].values:
        for source in SOURCES.keys() & set(budget["source"].values):  # twins only where asked for
            errors = budget["error"].sel(quantity=quantity, source=source)
            assert ((str(quantity), source) in drawn) == bool((errors > 0).any())
    at_map = budget.sel(normal_force=budget["normal_force"].max())
    assert np.isfinite(at_map["relative_total"].sel(quantity="closure"))
    assert "closure" in drawing.caption
    assert "numerical" in drawing.caption


def test_interpolated_errors_are_hollow(atlas):
    budget = atlas["error_budget/sliding"].to_dataset()
    with print_style():
        drawing = drawer_of("errors")(atlas, "sliding")
    axes = drawing.figure.axes[0]
    (hollow,) = [
        line
        for line in axes.lines
        if line.get_markerfacecolor() == "white" and line.get_xdata().size
    ]
    interpolated = budget["normal_force"][np.isnan(budget["finest_spacing"])]
    assert interpolated.size > 0
    _, newtons = force_unit(float(budget["normal_force"].max()))
    np.testing.assert_allclose(hollow.get_xdata() * newtons, interpolated)
