import numpy as np
import pytest

from fractalcontact.domain.correlation import correlation_dimension
from fractalcontact.domain.measures import measures_of_states
from fractalcontact.domain.multifractal import generalised_dimensions, lacunarity
from fractalcontact.surface.synthesis import self_affine

HEIGHTS = self_affine((128, 128), 0.1, 0.8, rms=1.0, seed=2)
PRESSURES = np.array([np.maximum(HEIGHTS - level, 0) for level in (np.inf, 1.5, 0.5)])


def spectrum_of(pressure):
    found = measures_of_states(pressure[np.newaxis], 0.1, [1.0])
    return found["generalised_dimension"].squeeze().values


def test_table_holds_what_the_measures_say():
    found = measures_of_states(PRESSURES, 0.1, [0.0, 10.0, 100.0])
    for variable in found.variables.values():
        assert {"units", "long_name"} <= set(variable.attrs)
    state, pressure = found.sel(normal_force=100.0), PRESSURES[2]
    pairs, dimension = (
        correlation_dimension(pressure > 0, 0.1),
        generalised_dimensions(pressure, 0.1),
    )
    assert state["correlation_dimension"] == pairs.value
    assert state["correlation_dimension_r_max"] == pairs.over[1]
    assert state["generalised_dimension_high"].sel(order=-1) == dimension[-1.0].high
    assert state["generalised_dimension_n"].sel(order=2) == dimension[2.0].n
    np.testing.assert_array_equal(state["lacunarity"], lacunarity(pressure > 0, 0.1).value)
    assert (state["lacunarity"] >= 1 - 1e-9).all()


def test_without_contact_there_is_no_measure():
    found = measures_of_states(PRESSURES[:1], 0.1, [0.0])
    for name in ("correlation_dimension", "generalised_dimension", "lacunarity"):
        assert np.isnan(found[name]).all()


def test_orders_do_not_rise_with_q_where_pressure_is_uneven():
    found = spectrum_of(np.exp(2 * HEIGHTS))
    assert (np.diff(found) < 0.02).all()
    assert found[-1] < found[2] - 0.02


def test_under_an_even_pressure_every_node_weighs_the_same():
    domain = np.asarray(PRESSURES[2] > 0, float)
    np.testing.assert_allclose(spectrum_of(7.0 * domain), spectrum_of(domain))


def test_states_must_belong_together():
    with pytest.raises(ValueError, match="belong together"):
        measures_of_states(PRESSURES, 0.1, [1.0])
