"""Spread over the members of an ensemble."""

from types import SimpleNamespace

import numpy as np
import xarray as xr
from scipy import stats

from fractalcontact.error_budget.ensemble_spread import seated_spread


def test_the_spread_of_the_closure_from_the_seat_is_that_of_one_more_member():
    """Half of the 95 % band of one more of five, counted from the seat of each member."""
    closing = np.random.default_rng(5).normal([[1.0], [1.5]], 0.1, (2, 5))
    ensemble = xr.Dataset(
        {"interface_closure": (("normal_force", "realisation"), closing)},
        {"normal_force": [2.0, 4.0]},
    )
    seated = xr.Dataset({"seated_closure": ("normal_force", [np.nan, 0.0, 0.5])})
    curve = SimpleNamespace(forces=np.array([1.0, 2.0, 4.0]), curve=seated)
    spread = np.std(closing[1] - closing[0], ddof=1) * np.sqrt(1 + 1 / 5)
    expected = [np.nan, 0.0, stats.t.ppf(0.975, 4) * spread]
    np.testing.assert_allclose(seated_spread(curve, ensemble), expected, rtol=1e-9, atol=1e-12)
