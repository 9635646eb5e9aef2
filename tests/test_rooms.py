"""A room of the package imports from lower floors alone, and nothing goes round in a circle."""

import ast
from pathlib import Path

import pytest

import fractalcontact

PACKAGE = Path(fractalcontact.__file__).parent
FLOORS = (
    ("core",),
    ("elastic", "surface"),
    ("contact", "roughness", "scan"),
    ("domain", "mechanics", "methods", "study"),
    ("size_effect", "experiments", "accuracy", "statements", "commands"),
    ("figures",),
)
FLOOR = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}


def imported(path):
    """Modules of the package that a file imports, inside functions too, as tuples of names."""
    here = path.relative_to(PACKAGE).with_suffix("").parts
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            if node.level:
                base = here[: len(here) - node.level]
            elif (node.module or "").split(".")[0] == "fractalcontact":
                base = ()
            else:
                continue
            inner = (node.module or "").split(".") if node.module else []
            module = (*base, *inner[0 if node.level else 1 :])
            for name in node.names:
                file = PACKAGE.joinpath(*module, f"{name.name}.py")
                found.add((*module, name.name) if file.is_file() else module)
        elif isinstance(node, ast.Import):
            assert not any(name.name.startswith("fractalcontact") for name in node.names), path
    return found


MODULES = {
    path.relative_to(PACKAGE).with_suffix("").parts: imported(path)
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
    while ready := [module for module, others in left.items() if not others]:
        for module in ready:
            del left[module]
        left = {module: others - set(ready) for module, others in left.items()}
    assert left == {}
