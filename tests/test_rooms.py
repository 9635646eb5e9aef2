"""A room of the package imports from lower floors alone, and only what it is asked for."""

import ast
from pathlib import Path

import pytest

import fractalcontact

PACKAGE = Path(fractalcontact.__file__).parent
FLOORS = (
    ("core",),
    ("elastic", "surface"),
    ("registration",),
    ("gridding",),
    ("contact", "roughness", "scan"),
    ("domain", "mechanics", "methods", "study"),
    ("size_effect", "experiments", "accuracy", "statements", "commands"),
    ("figures", "pages", "stages"),
)
FLOOR = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}


def imports(path):
    """Modules of the package that one imports, as tuples, lazily or not."""
    here = path.relative_to(PACKAGE).parts[:-1]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            inner = tuple(node.module.split(".")) if node.module else ()
            if node.level:
                module = (*here[: len(here) - node.level + 1], *inner)
            elif inner[:1] == ("fractalcontact",):
                module = inner[1:]
            else:
                continue
            for name in node.names:
                is_module = PACKAGE.joinpath(*module, f"{name.name}.py").is_file()
                yield (*module, name.name) if is_module else module
        elif isinstance(node, ast.Import):
            assert not any(name.name.startswith("fractalcontact") for name in node.names), path


MODULES = {
    path.relative_to(PACKAGE).with_suffix("").parts: set(imports(path))
    for path in PACKAGE.rglob("*.py")
}


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
def test_a_room_imports_nothing_but_what_is_asked_of_it(room):
    """Its ``__init__``, which every import of one of its modules runs, is a docstring."""
    body = ast.parse((PACKAGE / room / "__init__.py").read_text()).body
    assert [type(node) for node in body] == [ast.Expr]


#: Figures and pages read an atlas, and compute nothing of it. What they may import besides core and
#: each other: tables of the study; those of the laboratory, its rooms.
READERS = ("figures", "pages")
TABLES = {("study", name) for name in ("atlas", "figure_list", "stages")}
LABORATORY = ("accuracy", "experiments", "methods")


def beyond_reading(module, others):
    """Modules that one which only reads imports without leave."""
    rooms = {"core", *READERS}
    if module[:2] in (("figures", "accuracy"), ("figures", "experiments")):
        rooms |= set(LABORATORY)
    return {".".join(other) for other in others if other[0] not in rooms and other not in TABLES}


def test_figures_and_pages_import_only_what_reads_an_atlas():
    found = {
        ".".join(module): beyond_reading(module, others)
        for module, others in MODULES.items()
        if module[0] in READERS
    }
    assert {name: others for name, others in found.items() if others} == {}
