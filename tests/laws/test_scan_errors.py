"""Warning and fits where suspicious cells carry more than half of a deciding load."""

import numpy as np
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from fractalcontact.core.limits import RESOLVED_NODES
from fractalcontact.core.reported import Reported
from fractalcontact.laws.scan_errors import fits_undetermined, load_warning

NEAR_RESOLVED = st.sampled_from([0, 1, *range(RESOLVED_NODES - 1, RESOLVED_NODES + 2)])


def curves(share, nodes=20):
    """Curves over offset and load with the shares (offset, load) given, one direction."""
    share = np.array(share, float)[np.newaxis, :, np.newaxis]
    dims = ("direction", "offset", "resolution", "normal_force")
    offsets = 0.5 * np.arange(share.shape[1])
    forces = 256.0 * np.geomspace(0.1, 25.0, share.shape[-1])
    return xr.Dataset(
        {"suspect_load_share": (dims, share), "nodes": (dims, np.zeros(share.shape) + nodes)},
        coords={"direction": ["E"], "offset": offsets, "resolution": [1], "normal_force": forces},
    )


def warned_of(curves):
    reported = Reported.choose(curves, direction="E", offset=0.0, loads=[], reference=6400.0)
    return load_warning(curves, reported)


def test_a_warning_stands_where_more_than_half_of_a_deciding_load_rests_on_errors():
    assert warned_of(curves([[1, 0.4, 0.3], [1, 0, 0]])) == ""
    words = warned_of(curves([[1, 0.9, 0.8], [1, 0, 0]]))
    assert "80% of the reference load (v = 0 mm, the reported offset among them)" in words
    assert "in half or more of the states of 10 nodes (v = 0 mm)" in words
    words = warned_of(curves([[0.9, 0.9, 0.1], [0, 0, 0]]))
    assert "reference load" not in words
    assert "states of 10 nodes" in words


@settings(max_examples=50, deadline=None)
@given(st.lists(st.tuples(st.sampled_from([0.0, 0.4, 0.6, 1.0]), NEAR_RESOLVED), min_size=1))
def test_a_fit_is_undetermined_where_half_of_its_states_or_more_rest_on_errors(states):
    share, nodes = map(list, zip(*states, strict=True))
    found = fits_undetermined(curves([share], nodes=nodes)).item()
    fitted = [s for s, n in states if n >= RESOLVED_NODES] or [s for s, n in states if n > 0]
    on_errors = sum(s > 0.5 for s in fitted)
    assert found == (bool(fitted) and 2 * on_errors >= len(fitted))


def test_states_without_the_nodes_to_be_fitted_do_not_count():
    few = curves([[1, 1, 0]])
    few["nodes"][..., :2] = 3
    assert not fits_undetermined(few).any()
    few["nodes"][...] = 3
    assert fits_undetermined(few).all()
