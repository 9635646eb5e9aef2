import numpy as np
import pytest
from ensembles import ensemble

from contactlab.experiments.area_slope import area_slope
from fractalcontact.core.intervals import mean_interval
from fractalcontact.laws import theory

RECIPE = {
    "dimension": 2.2,
    "nodes": 128,
    "seeds": [1, 2, 3],
    "roll_off_share": 0.125,
    "loads": [0.02, 0.01],
}


@pytest.fixture(scope="module")
def slopes():
    return area_slope(RECIPE)


def test_many_hills_lie_between_the_theories():
    # The full suite takes the size at which it was promised.
    nodes, n_seeds = ensemble("surfaces with many hills")
    seeds = list(range(1, n_seeds + 1))
    found = area_slope(RECIPE | {"nodes": nodes, "seeds": seeds}).sel(surface="with_roll_off")
    corrected = found["corrected_kappa"]
    assert (corrected > theory.PERSSON_KAPPA).all()
    assert (corrected < theory.BUSH_GIBSON_THOMAS_KAPPA).all()
    assert (found["kappa"] > corrected).all()
    assert (mean_interval(corrected, axis=0).low > theory.PERSSON_KAPPA).all()


def test_a_few_hills_scatter_more(slopes):
    scatter = slopes["corrected_kappa"].std("seed", ddof=1)
    with_roll_off, without = (scatter.sel(surface=name) for name in slopes["surface"])
    assert (without > with_roll_off).all()


def test_kappa_is_the_share_over_the_load(slopes):
    np.testing.assert_allclose(slopes["reduced_pressure"], [0.01, 0.02])
    np.testing.assert_allclose(slopes["kappa"] * slopes["reduced_pressure"], slopes["area_share"])
    np.testing.assert_allclose(
        slopes["corrected_kappa"] * slopes["reduced_pressure"], slopes["corrected_share"]
    )


def test_neither_other_seeds_nor_the_order_of_the_loads_matter(slopes):
    again = area_slope(RECIPE | {"seeds": [2], "loads": [0.01, 0.02]})
    np.testing.assert_allclose(again["kappa"].sel(seed=2), slopes["kappa"].sel(seed=2), rtol=1e-9)


def test_everything_is_labelled(slopes):
    for name, variable in slopes.data_vars.items():
        assert {"units", "long_name"} <= variable.attrs.keys(), name
