"""How much load suspicious cells carry: exact where it is known, and said where it decides."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from samples import scan_of

from fractalcontact.core.limits import RESOLVED_NODES
from fractalcontact.core.reported import Reported
from fractalcontact.core.window import window_slices
from fractalcontact.joint.joint import composite_topography, describe_joint
from fractalcontact.joint.overlap import (
    fits_undetermined,
    load_warning,
    suspect_load_share,
    suspect_nodes,
)
from fractalcontact.states.sweep import joint_states
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine

STUDY = {
    "study": "tiny",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
    "defaults": {
        "material": "rock",
        "contact_directions": ["E"],
        "offsets": ["0 mm", "1 mm"],
        "loads": ["0.1 MPa", "5 MPa", "25 MPa"],
        "resolutions": [1, 2],
        "window": "16 mm",
        "map_offset": "0 mm",
    },
}
SETTINGS = resolve_settings(STUDY, "rock", {}, "tiny")
NEAR_RESOLVED = st.sampled_from([0, 1, *range(RESOLVED_NODES - 1, RESOLVED_NODES + 2)])
SPIKE = (21, 20)  # within the window, and away from its neighbours one cell East


def faces(spike=1.0):
    z = self_affine((48, 48), 0.5, 0.8, rms=0.5, seed=1)
    rng = np.random.default_rng(2)
    lower, upper = (z + 0.01 * rng.normal(size=z.shape) for _ in range(2))
    lower[SPIKE] += spike
    return scan_of(lower), scan_of(upper + 0.3)


def made(scans, **settings):
    return make_specimen(*scans, name="rock", **(window_arguments(SETTINGS) | settings))


def states_of(specimen, settings=SETTINGS):
    joint = describe_joint(specimen, settings)
    directions = settings.contact_directions
    solver = solver_settings({}, "tiny")
    return joint_states(
        specimen, joint, directions, slice(None), settings, settings.resolutions, solver
    )


@pytest.mark.parametrize("direction", ["E", "N", "W", "S"])
@pytest.mark.parametrize("cells", [0, 1, 3])
def test_a_node_is_suspicious_where_either_of_its_cells_is(direction, cells):
    specimen = made(faces())
    rng = np.random.default_rng(1)
    for name in ("suspect_lower", "suspect_upper", "overlap"):
        specimen[name] = (("y", "x"), rng.random(specimen["lower"].shape) < 0.1)
    # The composite of markers: 1 where the lower cell is one, and less what the upper one has.
    marked = specimen.assign(
        lower=specimen["suspect_lower"].astype(float),
        upper=-specimen["suspect_upper"].astype(float),
    )
    expected = composite_topography(marked, direction, cells) > 0
    if cells == 0:
        expected |= specimen["overlap"].values[window_slices(specimen)]
    np.testing.assert_array_equal(suspect_nodes(specimen, direction, cells), expected)


def test_the_load_share_is_that_of_the_pressure():
    pressure = np.array([[1.0, 2.0], [0.0, 5.0]])
    assert suspect_load_share(pressure, pressure > 10) == 0
    assert suspect_load_share(pressure, pressure == 0) == 0
    assert suspect_load_share(pressure, pressure == 2) == 0.25
    assert suspect_load_share(pressure, pressure >= 0) == 1
    assert suspect_load_share(0 * pressure, pressure >= 0) == 0


def test_a_spike_carries_what_first_touches_it_and_a_twin_nothing():
    states = states_of(made(faces())).isel(direction=0)
    share = states["suspect_load_share"].sel(resolution=1)
    assert share.isel(normal_force=0).values.tolist() == [1, 1]
    # Others take their part as the load rises.
    assert (share.diff("normal_force") <= 0).all()
    assert (share.isel(normal_force=-1) < 0.9).all()
    # Every second node leaves out the odd row of the spike.
    odd = states["suspect_load_share"].sel(resolution=2).isel(offset=0)
    assert odd.max() == 0
    twin = make_specimen(faces(spike=0.0)[0], name="rock", **window_arguments(SETTINGS))
    settings = replace(SETTINGS, offsets=[1.0])
    assert states_of(twin, settings)["suspect_load_share"].max() == 0


def test_filled_cells_stay_suspicious_but_carry_less():
    kept, filled = (made(faces(), outliers=value) for value in ("keep", "fill"))
    assert suspect_nodes(filled, "E", 0).any()
    shares = [states_of(s)["suspect_load_share"].sum().item() for s in (kept, filled)]
    assert shares[1] < 0.5 * shares[0]


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
