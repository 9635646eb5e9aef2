"""Solver methods register themselves by what their own file declares."""

import pytest

from contactlab.methods import registry
from contactlab.methods.method import Method
from contactlab.methods.registry import METHODS, PEERS


def test_every_method_is_there_in_its_order():
    assert {"dense", "paper", "polonsky-keer", "gauss-seidel", "nnls"} <= METHODS.keys()
    assert {"ContactMechanics ccg", "Tamaas"} <= PEERS.keys()
    for methods in (METHODS, PEERS):
        places = [(method.order, method.name) for method in methods.values()]
        assert places == sorted(places)


def test_a_file_may_declare_several():
    modes = {peer.options["mode"]: peer.solver for name, peer in PEERS.items() if "ASPHER" in name}
    assert list(modes) == ["active set", "fft", "float then double"]
    assert len(set(modes.values())) == 1


def test_a_declaration_with_a_property_that_no_method_has_is_an_error():
    with pytest.raises(TypeError, match="unexpected keyword argument"):
        Method(name="a", solver=print, speed="high")


def test_public_codes_are_used_where_their_packages_are_installed(monkeypatch):
    monkeypatch.setattr(registry, "find_spec", lambda package: package == "tamaas" or None)
    assert list(registry.installed_peers()) == ["Tamaas"]
