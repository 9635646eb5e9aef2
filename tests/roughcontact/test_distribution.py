"""The solver as a distribution: what its wheel holds and needs, and what its tests need."""

import ast
import re
import shutil
import subprocess
import sys
import zipfile
from email.parser import Parser

import pytest
from code_blocks import blocks, run_code
from packaging.requirements import Requirement
from places import ROOT

import roughcontact

SUPPORT = ROOT / "tests/support"


def test_its_wheel_holds_the_package_and_needs_three_libraries(tmp_path):
    project = tmp_path / "roughcontact"
    shutil.copytree(
        ROOT / "packages/roughcontact",
        project,
        ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"),
    )
    options = ["--quiet", "--no-build-isolation", "--no-deps", "--no-index", "-w", str(tmp_path)]
    subprocess.run([sys.executable, "-m", "pip", "wheel", *options, str(project)], check=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        (metadata,) = [name for name in names if name.endswith("METADATA")]
        stated = Parser().parsestr(archive.read(metadata).decode())
    source = ROOT / "src/roughcontact"
    expected = {
        path.relative_to(source.parent).as_posix()
        for path in source.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert {name for name in names if ".dist-info/" not in name} == expected
    assert any(name.endswith("licenses/LICENSE") for name in names)
    needed = {Requirement(text).name for text in stated.get_all("Requires-Dist")}
    assert needed == {"numpy", "scipy", "numba"}
    assert stated["Version"] == roughcontact.__version__
    assert "First script" in stated.get_payload()


def test_the_script_of_its_readme_solves_what_it_says():
    names = run_code("packages/roughcontact/README.md", "First script")
    state = names["state"]
    assert abs(state.mean_pressure - 5.0) < 1e-5
    assert state.space.boundary == "periodic"
    assert 0 < state.area < state.space.area
    (printed,) = (
        block.text
        for block in blocks("packages/roughcontact/README.md")
        if block.text.startswith("<ContactState")
    )
    number = r"{}[= ]([\d.e-]+)"
    stated = {
        name: float(re.search(number.format(name), printed)[1])
        for name in ("force", "closure", "area", "corrected area", "stiffness")
    }
    solved = [state.force, state.closure, state.area, state.corrected_area, state.stiffness]
    assert list(stated.values()) == pytest.approx(solved, rel=2e-3)


def test_the_folder_of_kernels_is_found_as_the_readme_says():
    code = "import roughcontact; print(roughcontact.kernel_cache.cache_folder())"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == str(roughcontact.kernel_cache.cache_folder())


def imported(path):
    """Top names that a file imports."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name.partition(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module.partition(".")[0]


def test_its_tests_need_nothing_else_of_the_project():
    """Only the solver, modules of tests/support that need no more, and test libraries."""
    queue = list((ROOT / "tests/roughcontact").rglob("*.py"))
    names, read = set(), set()
    while queue:
        path = queue.pop()
        if path not in read:
            read.add(path)
            found = set(imported(path))
            own = {name for name in found if (SUPPORT / f"{name}.py").is_file()}
            queue += [SUPPORT / f"{name}.py" for name in own]
            names |= found - own
    libraries = {"numpy", "scipy", "numba", "llvmlite", "pytest", "packaging", "roughcontact"}
    assert names - sys.stdlib_module_names <= libraries
    assert len(read) > len(list((ROOT / "tests/roughcontact").rglob("*.py")))
