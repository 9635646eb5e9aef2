import numpy as np
import pytest

from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.domain.correlation import correlation_dimension
from fractalcontact.domain.measures import domain_measures, measures_of_states, order_name
from fractalcontact.domain.multifractal import ORDERS
from fractalcontact.surface.synthesis import self_affine

HEIGHTS = self_affine((128, 128), 0.1, 0.8, rms=1.0, seed=2)


def states():
    levels = [np.inf, 1.5, 0.5]
    domains = np.array([level < HEIGHTS for level in levels])
    return domains, np.array([np.maximum(HEIGHTS - level, 0) for level in levels])


def row_of(domain, pressure):
    return domain_measures(domain, 0.1, pressure)


def test_row_holds_what_the_measures_say():
    domains, pressures = states()
    row = row_of(domains[2], pressures[2])
    box = dimension_of_domain(domains[2], 0.1)
    assert row["delta_sigma"] == box.dimension
    assert (row["delta_sigma_low"], row["delta_sigma_r_max"]) == (box.low, box.over[1])
    assert row["correlation_dimension"] == correlation_dimension(domains[2], 0.1).value
    assert all(isinstance(value, float) for value in row.values())
    assert len(row) == 6 * (2 + len(ORDERS))
    assert {order_name(q) for q in ORDERS} <= set(row)


def test_orders_do_not_rise_with_q_where_pressure_is_uneven():
    row = row_of(np.ones(HEIGHTS.shape, bool), np.exp(2 * HEIGHTS))
    found = [row[order_name(q)] for q in ORDERS]
    assert (np.diff(found) < 0.02).all()
    assert found[-1] < found[2] - 0.02


def test_under_an_even_pressure_every_node_weighs_the_same():
    domain = states()[0][2]
    even = row_of(domain, 7.0 * domain)
    for key, value in row_of(domain, domain).items():
        assert even[key] == pytest.approx(value, nan_ok=True)


def test_states_of_a_specimen():
    domains, pressures = states()
    found = measures_of_states(domains, pressures, 0.1, [0.0, 10.0, 100.0])
    for variable in found.variables.values():
        assert {"units", "long_name"} <= set(variable.attrs)
    row = row_of(domains[1], pressures[1])
    state = found.sel(normal_force=10.0)
    assert state["delta_sigma"] == row["delta_sigma"]
    assert state["generalised_dimension_high"].sel(order=-1) == row["d_minus_1_high"]
    assert np.isnan(found["delta_sigma"].sel(normal_force=0.0))
    assert np.isnan(found["lacunarity"].sel(normal_force=0.0)).all()
    assert np.isnan(found["local_slope"].sel(normal_force=0.0)).all()
    assert np.isfinite(found["local_slope"].sel(normal_force=100.0)).all()
    assert (found["lacunarity"].sel(normal_force=100.0) >= 1 - 1e-9).all()


def test_states_must_belong_together():
    domains, pressures = states()
    with pytest.raises(ValueError, match="belong together"):
        measures_of_states(domains, pressures, 0.1, [1.0])
