"""Solver methods register themselves by what their own file declares."""

import subprocess
import sys

import pytest

from contactlab.methods import registry
from contactlab.methods.registry import METHODS, MODULES, PEERS, Method, declared

EXAMPLE = """
from numba import njit
import a_public_code

METHOD = Method(name="mean plane", order=25, loads=("force",), hardness=("force",), likely=-4.5)
"""


def test_a_declaration_is_read_without_importing_its_file(tmp_path):
    path = tmp_path / "mean_plane.py"
    path.write_text(EXAMPLE)
    (method,) = declared(path)
    assert method == Method(
        name="mean plane",
        order=25,
        loads=("force",),
        hardness=("force",),
        likely=-4.5,
        module="mean_plane",
    )
    assert method.offers(force=1.0, hardness=2.0)
    assert not method.offers(closure=0.1)


def test_one_file_may_declare_several(tmp_path):
    path = tmp_path / "several.py"
    path.write_text("METHODS = (Method(name='a', options={'by': 'x'}), Method(name='b'))\n")
    assert [(method.name, method.options) for method in declared(path)] == [
        ("a", {"by": "x"}),
        ("b", {}),
    ]


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ("METHOD = Method(name='a', largest=LIMIT)", ValueError, r"a_file.py, line 1: largest of"),
        ("METHOD = Method(name='a', speed='high')", TypeError, "unexpected keyword argument"),
    ],
)
def test_a_declaration_that_cannot_be_read_is_an_error(tmp_path, text, error, words):
    (tmp_path / "a_file.py").write_text(text)
    with pytest.raises(error, match=words):
        declared(tmp_path / "a_file.py")


def test_what_declares_no_method_is_none(tmp_path):
    (tmp_path / "helper.py").write_text("def call():\n    return Method(name='a')\n")
    assert declared(tmp_path / "helper.py") == []


def test_every_method_is_there_in_its_order():
    assert {"dense", "paper", "polonsky-keer", "gauss-seidel", "nnls"} <= METHODS.keys()
    assert {"ContactMechanics ccg", "Tamaas"} <= PEERS.keys()
    for methods in (METHODS, PEERS):
        places = [(method.order, method.name) for method in methods.values()]
        assert places == sorted(places)
    assert {method.module for method in (METHODS | PEERS).values()} == set(MODULES)


@pytest.mark.parametrize("name", METHODS)
def test_a_method_is_what_its_module_declares(name):
    module = METHODS[name]._module
    assert callable(module.solve)
    assert module.METHOD.name == name


def test_public_codes_are_used_where_their_packages_are_installed(monkeypatch):
    monkeypatch.setattr(registry, "find_spec", lambda package: package == "tamaas" or None)
    assert list(registry.installed_peers()) == ["Tamaas"]


def test_reading_the_register_imports_neither_numba_nor_numpy():
    code = (
        "import sys; from contactlab.methods.registry import METHODS; "
        "sys.exit(str({'numba', 'numpy', 'scipy', 'xarray'} & sys.modules.keys() or '') or None)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
