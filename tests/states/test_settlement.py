"""Closure and stiffness of the interface: those of the window less those of the blocks."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.states.settlement import interface_closure, interface_stiffness


@pytest.mark.parametrize("interface", [0.02, 3.0, 5000.0])
def test_compliances_of_interface_and_blocks_add_up(interface):
    blocks = 40.0
    whole = 1 / interface + 1 / blocks
    assert float(interface_stiffness(whole, 1 / blocks)) == pytest.approx(interface)
    labelled = xr.DataArray([whole, np.nan], {"load": [1.0, 2.0]}, "load")
    found = interface_stiffness(labelled, 1 / blocks)
    np.testing.assert_allclose(found, [interface, np.nan])
    assert found.indexes["load"].tolist() == [1.0, 2.0]


def test_a_whole_no_softer_than_its_blocks_has_no_interface():
    compliance = np.array([0.2, 0.1, 0.05, np.inf])
    np.testing.assert_array_equal(interface_stiffness(compliance, 0.1) > 0, [1, 0, 0, 0])
    assert np.isnan(interface_stiffness(compliance, 0.1)[1:3]).all()
    # Without contact nothing resists.
    assert interface_stiffness(compliance, 0.1)[3] == 0


def test_flush_faces_close_by_nothing():
    closure, flush = np.array([0.3, 0.1]), np.array([False, True])
    np.testing.assert_allclose(interface_closure(closure, 0.25, flush), [0.05, 0.0])
    labelled = xr.DataArray(closure, {"load": [1.0, 2.0]}, "load")
    found = interface_closure(labelled, 0.25, xr.DataArray(flush, {"load": [1.0, 2.0]}, "load"))
    np.testing.assert_allclose(found, [0.05, 0.0])
