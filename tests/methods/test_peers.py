"""Other codes, where they are installed, solve the same problem."""

import pytest

from fractalcontact import NotConverged, solve_contact
from fractalcontact.methods import peers
from fractalcontact.reference_scenes import RoughScene

PEERS = peers.peer_methods()
needs_peers = pytest.mark.skipif(not PEERS, reason="the peers extra is not installed")


@pytest.fixture(scope="module")
def scene():
    return RoughScene(32, 0.8, 0.1, 1)


def load_of(name, reference):
    return {"force": reference.force} if name == "Tamaas" else {"closure": reference.closure}


@needs_peers
@pytest.mark.parametrize("name", PEERS)
def test_a_peer_finds_the_same_state(scene, name):
    reference = scene.single
    state = PEERS[name](scene.height, scene.space, rtol=1e-8, **load_of(name, reference))
    assert reference.error(state) < 1e-5
    assert state.residual < 1e-4
    assert state.area == pytest.approx(reference.state.area)


@needs_peers
@pytest.mark.parametrize("name", PEERS)
def test_a_peer_says_what_it_was_not_made_for(scene, name):
    other = {"closure": 0.01} if name == "Tamaas" else {"force": 1.0}
    with pytest.raises(ValueError, match=r"takes a \w+ only"):
        PEERS[name](scene.height, scene.space, **other)
    with pytest.raises(ValueError, match="knows no hardness"):
        PEERS[name](scene.height, scene.space, hardness=1.0, **load_of(name, scene.single))


@needs_peers
# ContactMechanics hands the limit of iterations to its own conjugate gradients only.
@pytest.mark.parametrize("name", [name for name in PEERS if "lbfgs" not in name])
def test_a_peer_that_gives_up_is_not_believed(scene, name, monkeypatch):
    monkeypatch.setattr(peers, "MAX_ITERATIONS", 2)
    with pytest.raises(NotConverged) as caught:
        PEERS[name](scene.height, scene.space, rtol=1e-9, **load_of(name, scene.single))
    assert caught.value.state.residual > 1e-9


def test_a_state_of_our_own_pressure_is_our_state(scene):
    ours = solve_contact(scene.height, scene.space, closure=scene.closure)

    class Peer:
        space = scene.space

    clearance = scene.height.max() - scene.height
    state = peers.state_of(Peer, ours.pressure, clearance, ours.closure)
    assert state.force == pytest.approx(ours.force)
    assert state.residual == pytest.approx(ours.residual, rel=1e-3, abs=1e-12)
