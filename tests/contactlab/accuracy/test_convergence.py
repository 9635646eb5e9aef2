"""Accuracy charts: their errors, orders and labels."""

import numpy as np
import pytest
from ensembles import ensemble

from contactlab.accuracy.convergence import error_over_spacing
from fractalcontact import HalfSpace, solve_contact
from fractalcontact.surface.synthesis import self_affine

CELLS = (5, 10, 20, 40)


@pytest.fixture(scope="module")
def hertz():
    return error_over_spacing("hertz", CELLS, ensemble("placements"))


def labelled(dataset):
    return all({"units", "long_name"} <= set(dataset[name].attrs) for name in dataset.variables)


def test_hertz_is_within_one_percent_at_twenty_cells(hertz):
    at_twenty = hertz.sel(cells_per_radius=20)
    for name in ("force_error", "radius_error", "peak_pressure_error"):
        assert 0 < at_twenty[name] < 0.01


#: Error of a peak pressure, a fraction, below which the iteration's end and its rounding count.
LEFT = 1e-5


# The finest peak pressures err by as little as the iteration leaves, and so do their orders.
@pytest.mark.parametrize(
    ("name", "order", "within"),
    [("force", 2, 0.2), ("radius", 1, 0.2), ("peak_pressure", 2, 0.5)],
)
def test_hertz_error_falls_at_its_order(hertz, name, order, within):
    errors = hertz[f"{name}_error"].values
    assert (np.diff(errors)[errors[:-1] > LEFT] < 0).all()
    assert hertz[f"{name}_order"] == pytest.approx(order, abs=within)
    assert hertz[f"{name}_order_low"] < hertz[f"{name}_order"] < hertz[f"{name}_order_high"]


def test_punch_error_falls_at_its_order():
    punch = error_over_spacing("punch", CELLS, ensemble("placements"))
    assert (np.diff(punch["force_error"]) < 0).all()
    assert punch["force_order"] == pytest.approx(1, abs=0.25)
    assert punch["force_order_low"] < punch["force_order"] < punch["force_order_high"]
    assert labelled(punch)


def test_hertz_order_needs_three_resolutions():
    assert np.isnan(error_over_spacing("hertz", (5, 8), 1)["force_order"])


def test_every_variable_is_labelled(hertz):
    assert labelled(hertz)


def test_stiffer_self_term_carries_more():
    height = self_affine((32, 32), 0.1, 0.5, rms=0.1, seed=1)
    # From Love's 1.122 to the rigid square's 0.868 a lone node sinks ever less under its force.
    forces = [
        solve_contact(height, HalfSpace((32, 32), 0.1, 30e3, kernel=kernel), closure=0.1).force
        for kernel in ("love", "inscribed disc", "equal-area disc", "rigid square")
    ]
    assert (np.diff(forces) > 0).all()
