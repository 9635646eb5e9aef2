"""The package as a library: what a user types, sees and reads, without the workflow."""

import importlib
import inspect
import logging
import re
import subprocess
import sys
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest
import yaml
from packaging.requirements import Requirement
from places import ROOT

import fractalcontact
from fractalcontact import HalfSpace, InputError, box_dimension, solve_contact
from fractalcontact.scan import formats
from fractalcontact.scan.options import ScanOptions
from roughcontact import kernel_cache

PACKAGE = Path(fractalcontact.__file__).parent


def run(code):
    """Standard output of a fresh interpreter."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout


def test_every_name_is_there_documented_and_completed():
    names = fractalcontact.__all__
    assert {*names, "__version__"} <= set(dir(fractalcontact))
    for name in names:
        assert inspect.getdoc(getattr(fractalcontact, name)), name
    with pytest.raises(AttributeError, match="no attribute 'solve_contacts'") as error:
        fractalcontact.solve_contacts  # noqa: B018
    assert error.value.name == "solve_contacts"  # Python proposes the right one from these two
    assert error.value.obj is fractalcontact


def test_nothing_is_imported_before_it_is_asked_for():
    heavy = "{'numpy', 'xarray', 'numba', 'matplotlib'} & set(sys.modules)"
    printed = run(f"import sys, fractalcontact as f; dir(f); f.__version__; print({heavy})")
    assert printed == "set()\n"


def distributions(requirements: list[str]) -> set[str]:
    """Names of requirements without their extras and versions."""
    return {Requirement(each).name for each in requirements}


def test_the_solver_asks_for_nothing_that_only_a_study_needs():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = settings["optional-dependencies"]
    needed = {"snakemake", "jinja2", "matplotlib", "jsonschema", "trimesh", "h5py"}
    assert needed <= distributions(extras["scans"] + extras["study"])
    assert not needed & distributions(settings["dependencies"])
    unneeded = [*needed, "SurfaceTopography", "tifffile", "x3pio"]
    printed = run(
        f"import sys; from fractalcontact import *; print(sys.modules.keys() & {unneeded})"
    )
    assert printed.strip() == "set()"


def test_the_stub_names_what_the_package_exports():
    stub = (PACKAGE / "__init__.pyi").read_text()
    pairs = re.findall(r"^from ([\w.]+) import (\w+) as \2$", stub, re.MULTILINE)
    exported = {name: home for home, name in pairs}
    assert sorted(exported) == fractalcontact.__all__
    for name, home in exported.items():
        module = importlib.import_module(home, "fractalcontact")
        assert getattr(module, name) is getattr(fractalcontact, name)
    assert (PACKAGE / "py.typed").is_file()
    data = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    assert data["package-data"]["fractalcontact"] == ["py.typed", "*.pyi"]


@pytest.mark.full
def test_a_type_checker_sees_the_signatures(tmp_path):
    script = tmp_path / "client.py"
    script.write_text(
        "from fractalcontact import HalfSpace, solve_contact\n"
        "import numpy as np\n"
        "space = HalfSpace((8, 8), 0.1, 1e4)\n"
        "state = solve_contact(np.zeros((8, 8)), space, closure=0.1)\n"
        "reveal_type(state.closure)\n"
        "space.modulos\n"
        "HalfSpace((8, 8), 'wide', 1e4)\n"
    )
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "mypy",
            "--cache-dir",
            str(ROOT / ".mypy_cache/client"),
            str(script),
        ],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={"MYPYPATH": str(ROOT / "src"), "PATH": "/usr/bin:/bin"},
    )
    found = [line for line in done.stdout.splitlines() if line.startswith("client.py")]
    assert 'Revealed type is "float"' in found[0].replace("builtins.", "")
    assert 'has no attribute "modulos"' in found[1]
    assert 'Argument 2 to "HalfSpace" has incompatible type "str"' in found[2]


def test_the_version_stands_in_one_place():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == fractalcontact.__version__
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"(?m)^## ([\d.]+) - (\S+)$", changes)
    assert newest.groups() == (citation["version"], str(citation["date-released"]))
    for project in (ROOT, ROOT / "packages/roughcontact"):
        settings = tomllib.loads((project / "pyproject.toml").read_text())
        assert settings["tool"]["setuptools"]["dynamic"]["version"] == {
            "attr": "roughcontact.__version__"
        }


def test_one_spacing_is_that_of_square_cells():
    assert HalfSpace((4, 6), 0.1, 1e4) == HalfSpace((4, 6), (0.1, 0.1), 1e4)
    assert HalfSpace((4, 6), np.float32(0.5), 1e4).spacing == (0.5, 0.5)
    for wrong in (True, -0.1, 0, np.nan, "0.1", (0.1,), None):
        with pytest.raises(ValueError, match=r"^spacing"):
            HalfSpace((4, 6), wrong, 1e4)


def test_e_star_is_the_modulus_by_a_word_that_will_go():
    space = HalfSpace((4, 6), 0.1, modulus=1e4)
    with pytest.warns(DeprecationWarning, match="write modulus") as told:
        assert HalfSpace((4, 6), 0.1, e_star=1e4) == space
    assert told[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="write modulus") as told:
        assert space.e_star == space.modulus
    assert told[0].filename == __file__
    for moduli in ({}, {"modulus": 1e4, "e_star": 1e4}):
        with pytest.raises(TypeError, match="expected one modulus"):
            HalfSpace((4, 6), 0.1, **moduli)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        HalfSpace((4, 6), 0.1, 1e4)


def test_what_a_user_holds_is_shown_in_a_line():
    space = HalfSpace((16, 20), (0.1, 0.2), 1e4)
    assert eval(repr(space)) == space
    rigid = HalfSpace((16, 20), 0.1, 1e4, kernel="rigid square")
    assert eval(repr(rigid)) == rigid
    heights = np.zeros(space.shape)
    heights[8, 10] = 0.01
    state = solve_contact(heights, space, closure=0.001)
    shown = repr(state)
    assert "\n" not in shown
    assert len(shown) < 160
    assert f"force={state.force:.6g} N, closure=0.001 mm, area=0.02 mm2, 1 nodes" in shown
    capped = solve_contact(heights, space, closure=0.001, hardness=1.5)
    assert "hardness=1.5 MPa" in repr(capped)
    square = box_dimension(np.ones((64, 64), bool), 0.1)
    assert re.match(r"<BoxDimension 2 \[2, 2\] from \d+ sizes, ", repr(square))
    nothing = box_dimension(np.zeros((8, 8), bool), 0.1)
    assert repr(nothing) == f"<BoxDimension: none ({nothing.reason})>"


def test_compiling_is_told_once(tmp_path, caplog, monkeypatch):
    monkeypatch.setattr(kernel_cache.KernelCache, "_announced", False)
    made = tmp_path / "made.py"
    factors = {"twice": 2, "thrice": 3, "fourfold": 4}
    made.write_text("".join(f"def {of}(x):\n    return {n} * x\n\n\n" for of, n in factors.items()))
    monkeypatch.syspath_prepend(tmp_path)
    module = importlib.import_module("made")
    monkeypatch.setattr(kernel_cache, "_folders", lambda: (tmp_path, [tmp_path]))
    with caplog.at_level(logging.INFO, "roughcontact"):
        for function in (module.twice, module.thrice):
            kernel = kernel_cache.njit(function, cache=True)
            kernel(2.0)
        told = [record for record in caplog.records if record.levelno == logging.WARNING]
        assert len(told) == 1
        assert "about a minute" in told[0].getMessage()
        assert [r.name for r in caplog.records] == ["roughcontact"] * 3
        caplog.clear()
        again = kernel_cache.njit(module.twice, cache=True)
        assert again(2.0) == 4.0
        assert caplog.records == []  # from the disk
        # Another process, which needs a kernel that the first one did not.
        monkeypatch.setattr(kernel_cache.KernelCache, "_announced", False)
        assert kernel_cache.njit(module.fourfold, cache=True)(2.0) == 8.0
        assert [record.levelno for record in caplog.records] == [logging.INFO]


def test_a_format_whose_library_is_missing_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "trimesh", None)
    path = tmp_path / "face.stl"
    path.write_bytes(b"solid face\nendsolid face\n")
    with pytest.raises(InputError, match=r"takes trimesh, .*pip install 'fractalcontact\[scans\]'"):
        formats.read_raw(path, ScanOptions())


def test_the_conda_environment_has_the_versions_of_the_lock():
    pinned = re.findall(
        r"^([\w.-]+==\S+)", (ROOT / "requirements/study.lock").read_text(), re.MULTILINE
    )
    conda = re.findall(
        r"^([\w.-]+==\S+)", (ROOT / "requirements/conda.txt").read_text(), re.MULTILINE
    )
    assert conda == pinned
    assert len(conda) > 50
    assert "--hash" not in (ROOT / "requirements/conda.txt").read_text()
    pip = yaml.safe_load((ROOT / "environment.yml").read_text())["dependencies"][-1]["pip"]
    assert pip == ["-r requirements/conda.txt", "-e ."]
