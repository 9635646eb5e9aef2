"""Both estimators of Delta_sigma on synthetic surfaces."""

import numpy as np
import pytest
from ensembles import ensemble

from contactlab.experiments.delta_sigma import dimension_test, synthetic_surface
from contactlab.experiments.units import SIDE
from fractalcontact.core.intervals import mean_interval
from fractalcontact.domain.box_dimension import dimension_of_domain
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

RECIPE = {
    "dimensions": [2.2, 2.5],
    "sizes": [128, 256],
    "seeds": list(range(1, ensemble("surfaces of every dimension") + 1)),
    "loads": [0.05, 0.01],
    "resolutions": [1, 2, 4, 8],
}


@pytest.fixture(scope="module")
def found():
    return dimension_test(RECIPE)


@pytest.fixture(scope="module")
def capped():
    more = {"hardness": 0.5, "capped_loads": [0.05, 0.5, 0.98], "capped_size": 128}
    small = {"dimensions": [2.2], "sizes": [64], "seeds": [1, 2], "loads": [0.05]}
    return dimension_test(RECIPE | small | more)


def test_domain_that_fills_the_window_has_dimension_2(capped):
    full = capped.isel(capped_pressure=-1)
    assert (full["capped_area_share"] > 0.97).all()
    assert full["capped_mean_delta_sigma_area"].item() == pytest.approx(2, abs=0.02)
    assert full["capped_mean_delta_sigma_box"].item() == pytest.approx(2, abs=0.02)
    assert (capped["capped_mean_delta_sigma_box"].diff("capped_pressure") > 0).all()
    assert (capped["capped_area_share"].diff("capped_pressure") > 0).all()


def test_area_follows_the_light_load_theory(found):
    # A_r = kappa F / (E* h'_rms) and h'_rms ~ s^(H - 1).
    light = found["mean_delta_sigma_area"].sel(reduced_pressure=0.01)
    np.testing.assert_allclose(
        light, found["light_load_delta"].values[:, None] + 0 * light, atol=0.2
    )
    np.testing.assert_allclose(found["light_load_delta"], [1.8, 1.5])


def test_boxes_are_counted_on_the_same_state(found):
    size, seed, load = 256, 2, 0.01
    surface = synthetic_surface(2.5, size, seed)
    chosen = found.sel(dimension=2.5, size=size, seed=seed, reduced_pressure=load)
    force = load * float(chosen["rms_slope"]) * SIDE**2
    space = HalfSpace((size, size), (SIDE / size,) * 2, 1.0)
    domain = solve_contact(surface, space, force=force).in_contact
    assert int(chosen["nodes"].sel(resolution=1)) == domain.sum()
    box = dimension_of_domain(domain, SIDE / size)
    assert float(chosen["delta_sigma_box"]) == pytest.approx(box.dimension)
    assert float(chosen["boxes_per_node"].sel(resolution=1)) == 1


def test_means_and_trends(found):
    values = found["difference"].sel(dimension=2.5, size=128, reduced_pressure=0.05)
    area = found["delta_sigma_area"].sel(dimension=2.5, size=128, reduced_pressure=0.05)
    box = found["delta_sigma_box"].sel(dimension=2.5, size=128, reduced_pressure=0.05)
    np.testing.assert_allclose(values, area - box)
    mean = found.sel(dimension=2.5, size=128, reduced_pressure=0.05)
    expected = [float(end) for end in mean_interval(values).ends]
    assert [float(mean[f"mean_difference{end}"]) for end in ("", "_low", "_high")] == pytest.approx(
        expected
    )
    agrees = found["mean_difference_low"] * found["mean_difference_high"] <= 0
    np.testing.assert_array_equal(found["difference_agrees"], agrees)
    both = found["difference"].sel(dimension=2.5, reduced_pressure=0.05).mean("seed")
    assert float(found["growth"].sel(dimension=2.5, reduced_pressure=0.05)) == pytest.approx(
        float(both.sel(size=256) - both.sel(size=128))
    )


def test_same_pressure_touches_less_of_a_finer_surface(found):
    other = dimension_test(RECIPE | {"same_pressure": True, "seeds": [1], "dimensions": [2.5]})
    first, second = (d.sel(dimension=2.5, seed=1, reduced_pressure=0.05) for d in (found, other))
    first, second = (d["nodes"].sel(resolution=1) / d["size"] ** 2 for d in (first, second))
    assert float(second.sel(size=128)) == float(first.sel(size=128))
    assert float(second.sel(size=256)) < 0.85 * float(first.sel(size=256))


def test_neither_other_seeds_nor_the_order_of_the_loads_matter(found):
    again = dimension_test(RECIPE | {"seeds": [2], "loads": [0.01, 0.05], "dimensions": [2.5]})
    for name in ("delta_sigma_area", "delta_sigma_box"):
        np.testing.assert_allclose(
            again[name].sel(seed=2, dimension=2.5), found[name].sel(seed=2, dimension=2.5)
        )


def test_everything_is_labelled(found, capped):
    for made in (found, capped):
        for name, variable in made.data_vars.items():
            assert {"units", "long_name"} <= variable.attrs.keys(), name
    assert found.attrs["summary"].count("Delta_g") == 2
    assert "capped_pressure" not in found.dims
