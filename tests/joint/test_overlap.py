"""How much load suspicious cells carry: exact where it is known, and said where it decides."""

from dataclasses import replace

import numpy as np
import pytest
import tiny_pairs
from samples import scan_of

from fractalcontact.core.window import window_slices
from fractalcontact.joint.joint import composite_topography, describe_joint
from fractalcontact.joint.overlap import (
    suspect_load_share,
    suspect_nodes,
)
from fractalcontact.states.sweep import joint_states
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine

DEFAULTS = tiny_pairs.STUDY["defaults"] | {
    "offsets": ["0 mm", "1 mm"],
    "loads": ["0.1 MPa", "5 MPa", "25 MPa"],
    "resolutions": [1, 2],
    "map_offset": "0 mm",
}
STUDY = tiny_pairs.STUDY | {"defaults": DEFAULTS}
SETTINGS = resolve_settings(STUDY, "rock", {}, "tiny")
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
