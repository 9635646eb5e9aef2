"""A room of the package imports from lower floors alone, and exports what others use of it."""

import ast
import importlib
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest
from places import ROOT

import fractalcontact

PACKAGE = Path(fractalcontact.__file__).parent
FLOORS = (
    ("core",),
    ("elastic", "surface"),
    ("contact", "roughness", "scan"),
    ("domain", "mechanics", "methods", "study"),
    ("size_effect", "experiments", "accuracy", "statements", "commands"),
    ("figures", "pages", "stages"),
)
FLOOR = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}
#: Who uses the package from outside.
USERS = [
    *ROOT.glob("workflow/**/*.py"),
    *ROOT.glob("workflow/**/*.smk"),
    *ROOT.glob("benchmarks/*.py"),
]


@cache
def imports(path):
    """As :func:`_imports`, read once."""
    return tuple(_imports(path))


def _imports(path):
    """Pairs of a module of the package, as a tuple, and a name taken from it, lazy ones too."""
    text = path.read_text()
    if path.suffix == ".smk":  # a Python file but for the words of Snakemake
        lines = text.splitlines()
        text = "\n".join(_import_lines(lines))
    here = path.relative_to(PACKAGE).parts[:-1] if path.is_relative_to(PACKAGE) else ()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            inner = tuple(node.module.split(".")) if node.module else ()
            if node.level:
                module = (*here[: len(here) - node.level + 1], *inner)
            elif inner[:1] == ("fractalcontact",):
                module = inner[1:]
            else:
                continue
            for name in node.names:
                if PACKAGE.joinpath(*module, f"{name.name}.py").is_file():
                    yield (*module, name.name), None
                else:
                    yield module, name.name
        elif isinstance(node, ast.Import):
            assert not any(name.name.startswith("fractalcontact") for name in node.names), path


def _import_lines(lines):
    inside = False
    for line in lines:
        if inside or line.lstrip().startswith("from fractalcontact"):
            yield line.strip()
            inside = ("(" in line or inside) and ")" not in line


MODULES = {
    path.relative_to(PACKAGE).with_suffix("").parts: {module for module, _ in imports(path)}
    for path in PACKAGE.rglob("*.py")
}


def used_of(room):
    """Module of each name of a room that other rooms, the workflow or the benchmarks use."""
    found = defaultdict(set)
    inside = PACKAGE / room
    for path in [*PACKAGE.rglob("*.py"), *USERS]:
        if not path.is_relative_to(inside):
            for module, name in imports(path):
                # What is named as its module is taken from there: a package cannot have both.
                if module[:1] == (room,) and len(module) > 1 and name not in (None, module[-1]):
                    found[name].add("." + ".".join(module[1:]))
    return {name: sorted(modules) for name, modules in found.items()}


def test_every_module_has_a_room_and_every_room_a_floor():
    rooms = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    assert rooms == set(FLOOR)
    assert [path.name for path in PACKAGE.glob("*.py")] == ["__init__.py"]


@pytest.mark.parametrize("room", FLOOR)
def test_a_room_imports_from_lower_floors_alone(room):
    upward = [
        f"{'.'.join(module)} imports {'.'.join(other)}"
        for module, others in MODULES.items()
        for other in others
        if module[0] == room and other[:1] != (room,) and FLOOR[other[0]] >= FLOOR[room]
    ]
    assert upward == []


def test_no_import_goes_round_in_a_circle():
    left = {module: others & MODULES.keys() for module, others in MODULES.items()}
    while ready := {module for module, others in left.items() if not others}:
        left = {module: left[module] - ready for module in left.keys() - ready}
    assert left == {}


@pytest.mark.parametrize("room", FLOOR)
def test_a_room_exports_what_others_use_of_it_and_nothing_else(room):
    used = used_of(room)
    assert [name for name, modules in used.items() if len(modules) > 1] == []
    package = importlib.import_module(f"fractalcontact.{room}")
    assert getattr(package, "__all__", []) == sorted(used)
    for name, (module,) in used.items():
        home = importlib.import_module(f"fractalcontact.{room}{module}")
        assert getattr(package, name) is getattr(home, name)
