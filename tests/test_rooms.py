"""A room of the package imports from lower floors alone, and only what it is asked for."""

import ast
import re
import sys
from pathlib import Path

import pytest

import fractalcontact

SOURCES = Path(fractalcontact.__file__).parents[1]
#: Packages and their rooms, by floor.
FLOORS = (
    ("roughcontact",),
    ("roughcontact.elastic",),
    ("roughcontact.contact",),
    ("core",),
    ("surface",),
    ("registration",),
    ("gridding",),
    ("roughness", "scan"),
    ("joint", "study"),
    ("states",),
    ("domain", "flow", "laws"),
    ("size_effect", "error_budget", "measured", "statements"),
    ("ensemble", "report"),
    ("figures", "pages", "stages"),
    ("cards",),
    ("commands",),
    ("contactlab.methods",),
    ("contactlab.accuracy", "contactlab.experiments"),
    ("contactlab.figures", "contactlab.commands"),
)
FLOOR = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}
PACKAGES = ("roughcontact", "fractalcontact", "contactlab")


def module_name(path):
    """Name of a module as a tuple."""
    return path.relative_to(SOURCES).with_suffix("").parts


def room_of(module):
    """The room a module is in; of the modules beside the rooms, the package."""
    package, *inner = module
    if package == "fractalcontact":
        return inner[0]
    return ".".join(module[:2]) if SOURCES.joinpath(*module[:2]).is_dir() else package


def imports(path):
    """Modules of the packages that one imports, as tuples, lazily or not."""
    here = module_name(path)[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            inner = tuple(node.module.split(".")) if node.module else ()
            if node.level:
                module = (*here[: len(here) - node.level + 1], *inner)
            elif inner[:1] and inner[0] in PACKAGES:
                module = inner
            else:
                continue
            for name in node.names:
                is_module = SOURCES.joinpath(*module, f"{name.name}.py").is_file()
                yield (*module, name.name) if is_module else module
        elif isinstance(node, ast.Import):
            assert not any(name.name.startswith(PACKAGES) for name in node.names), path


@pytest.fixture(scope="module")
def modules():
    """Every module of the packages, with those that it imports."""
    return {
        module_name(path): set(imports(path))
        for package in PACKAGES
        for path in (SOURCES / package).rglob("*.py")
        if path.parent != SOURCES / package or path.stem != "__init__"
    }


def test_every_module_has_a_room_and_every_room_a_floor(modules):
    assert {room_of(module) for module in modules} == set(FLOOR)
    assert [path.name for path in SOURCES.glob("fractalcontact/*.py")] == ["__init__.py"]


def test_contributing_has_the_floors_of_the_chain():
    text = (SOURCES.parent / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rows = re.findall(r"(?m)^\| (\d+) \| (.+?) \|", text.partition("| floor | rooms |")[2])
    chain = [rooms for rooms in FLOORS if not any("contact" in room for room in rooms)]
    assert {int(floor): set(re.findall(r"`(\w+)`", rooms)) for floor, rooms in rows} == {
        floor: set(rooms) for floor, rooms in enumerate(chain)
    }


@pytest.mark.parametrize("room", FLOOR)
def test_a_room_imports_from_lower_floors_alone(modules, room):
    upward = [
        f"{'.'.join(module)} imports {'.'.join(other)}"
        for module, others in modules.items()
        for other in others
        if room_of(module) == room != room_of(other) and FLOOR[room_of(other)] >= FLOOR[room]
    ]
    assert upward == []


def test_the_solver_needs_nothing_but_numpy_scipy_and_numba():
    needed = set()
    for path in (SOURCES / "roughcontact").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                needed |= {name.name.partition(".")[0] for name in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                needed.add(node.module.partition(".")[0])
    assert needed - sys.stdlib_module_names == {"numpy", "scipy", "numba", "llvmlite"}


def test_no_import_goes_round_in_a_circle(modules):
    left = {module: others & modules.keys() for module, others in modules.items()}
    while ready := {module for module, others in left.items() if not others}:
        left = {module: left[module] - ready for module in left.keys() - ready}
    assert left == {}


@pytest.mark.parametrize("room", [room for room in FLOOR if room not in PACKAGES])
def test_a_room_imports_nothing_but_what_is_asked_of_it(room):
    """Its ``__init__``, which every import of one of its modules runs, is a docstring."""
    folder = room if "." in room else f"fractalcontact.{room}"
    body = ast.parse(
        (SOURCES / folder.replace(".", "/") / "__init__.py").read_text(encoding="utf-8")
    ).body
    assert [type(node) for node in body] == [ast.Expr]


#: Figures, pages and cards read an atlas, and compute nothing of it. What they may import besides
#: core, the report and each other: tables of the study. Those of the laboratory may import its
#: rooms.
READERS = ("figures", "pages", "cards")
TABLES = {("study", name) for name in ("atlas", "atlas_parts", "campaign", "figure_list", "stages")}


def beyond_reading(module, others):
    """Modules that one which only reads imports without leave."""
    rooms = {"core", "report", *READERS}
    return {
        ".".join(other)
        for other in others
        if room_of(other) not in rooms and other[1:] not in TABLES
    }


def test_figures_and_pages_import_only_what_reads_an_atlas(modules):
    found = {
        ".".join(module): beyond_reading(module, others)
        for module, others in modules.items()
        if room_of(module) in READERS
    }
    assert {name: others for name, others in found.items() if others} == {}
