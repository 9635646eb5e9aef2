"""Laboratory tests of a specimen as its sidecar or the study states them under ``measured``.

A measured curve says little without what its displacement contains, its seat, branch and cycle:
what is not said is refused with what to write.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.settings import TEST_COLUMNS, MeasuredTest
from ..core.units import length_factor, quantity
from .scan_files import refuse_outside_link

#: Keys that the sidecar must state of each kind of test, and keys that it may.
_NEEDS = {
    "closure": ("file", "gauge", "seat", "branch", "cycle"),
    "flow": ("file", "way", "branch", "cycle"),
    "dilatancy": ("file", "pressure", "direction"),
    "shear": ("file", "pressure", "direction"),
    "strength": ("file", "direction"),
}
_MAY = {
    "closure": ("columns", "error", "largest_pressure", "calibrate"),
    "flow": ("columns", "largest_pressure"),
    "dilatancy": ("columns", "error"),
    "shear": ("columns", "error"),
    "strength": ("columns", "error"),
}
#: What to write for a key that is not stated.
_WRITE = {
    "file": "the table of its readings, such as 'file: closure_test.csv'",
    "gauge": (
        "what the displacement contains: 'gauge: joint', or the rock between the gauge points as "
        "'gauge: 4 um/MPa' or 'gauge: {length: 100 mm, modulus: 60 GPa}'"
    ),
    "seat": "the pressure that the displacement counts from, such as 'seat: 0.25 MPa'",
    "branch": "'branch: load', 'branch: unload' or 'branch: reload'",
    "cycle": "'cycle: 1' for the first loading and unloading, else the number of the cycle",
    "way": "'way: along' or 'way: across' the sliding",
    "pressure": "the normal pressure that is held, such as 'pressure: 5 MPa'",
    "direction": "the direction of sliding, 'direction: E', N, W or S",
}
_MAX_GAUGE = 100  # characters
_COMPLIANCE = re.compile(r"\s*(?P<number>[-+.\deE]+)\s*(?P<unit>\S+)\s*/\s*MPa\s*")


def tests_of(stated: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any]]]:
    """Kind and keys of each test that a specimen's ``measured`` states."""
    return [
        (kind, test)
        for kind, tests in stated.items()
        for test in (tests if isinstance(tests, list) else [tests])
    ]


def test_files(stated: Mapping[str, Any], folder: Path) -> list[Path]:
    """Files of the tests that a specimen's ``measured`` states; they are no scans."""
    return [folder / str(test["file"]) for _, test in tests_of(stated) if "file" in test]


def resolve_tests(stated: Mapping[str, Any], where: str, folder: Path) -> list[MeasuredTest]:
    """Tests of a specimen, their quantities in mm and MPa.

    Parameters
    ----------
    stated : mapping
        ``measured``, which passed the schema.
    where : str
        For errors.
    folder : Path
        That the files stand in.

    Raises
    ------
    InputError
        If a key is missing, has no meaning for its test, or contradicts another one.
    """
    tests = [_resolved(kind, test, f"{where}.{kind}", folder) for kind, test in tests_of(stated)]
    labels = [(test.kind, test.label) for test in tests]
    if twice := next((one for one in labels if labels.count(one) > 1), None):
        raise InputError(
            f"{where}.{twice[0]}: two tests are '{twice[1]}'; keep one, or state another 'cycle'"
        )
    if sum(bool(test.calibrate) for test in tests) > 1:
        raise InputError(
            f"{where}: two tests calibrate a constant; keep 'calibrate' in one, so that the others "
            "are predicted"
        )
    return tests


def require_files(tests: Iterable[MeasuredTest]) -> None:
    """Refuse tests whose file is missing, or a link out of its folder.

    Raises
    ------
    InputError
    """
    for path in (Path(test.file) for test in tests):
        if not path.exists():
            raise InputError(f"{path}: no such file, which 'measured' names; put it there")
        refuse_outside_link(path, path.parent)


def _resolved(kind: str, test: Mapping[str, Any], where: str, folder: Path) -> MeasuredTest:
    needs, may = _NEEDS[kind], _MAY[kind]
    for key in needs:
        if key not in test:
            raise InputError(f"{where}: '{key}' is not stated; write {_WRITE[key]}")
    if idle := sorted(test.keys() - {*needs, *may}):
        raise InputError(f"{where}: key '{idle[0]}' has no meaning for a {kind} test; remove it")
    branch, cycle = test.get("branch", ""), test.get("cycle", 1)
    if (branch, cycle > 1) in (("load", True), ("reload", False)):
        raise InputError(
            f"{where}: 'branch: {branch}' in cycle {cycle}; the first loading is 'branch: load' of "
            "cycle 1, any later one 'branch: reload' of cycle 2 or more"
        )

    def positive(key: str, kind: str) -> float:
        value = quantity(test[key], kind, f"{where}.{key}") if key in test else float("nan")
        if value <= 0:
            raise InputError(f"{where}.{key}: {test[key]!r} must be above 0")
        return value

    wanted = TEST_COLUMNS[kind]
    columns = dict(test.get("columns", {}))
    if kind == "flow" and "hydraulic_aperture" in columns:
        wanted = (wanted[0], "hydraulic_aperture")
    if odd := sorted(columns.keys() - set(wanted)):
        raise InputError(
            f"{where}.columns: no column '{odd[0]}' of a {kind} test; expected {', '.join(wanted)}"
        )
    error_of = {"closure": "length", "dilatancy": "length"}.get(kind, "pressure")
    return MeasuredTest(
        kind=kind,
        file=str(folder / test["file"]),
        columns={name: columns.get(name, name) for name in wanted},
        branch=branch,
        cycle=cycle,
        way=test.get("way", ""),
        direction=test.get("direction", ""),
        seat=positive("seat", "pressure"),
        pressure=positive("pressure", "pressure"),
        largest_pressure=positive("largest_pressure", "pressure"),
        compliance=_compliance(test.get("gauge", "joint"), f"{where}.gauge"),
        error=positive("error", error_of),
        calibrate=test.get("calibrate", ""),
    )


def _compliance(gauge: Any, where: str) -> float:
    """Displacement of the rock between the gauge points, mm per MPa."""
    if gauge == "joint":
        return 0.0
    if isinstance(gauge, Mapping):
        for key in ("length", "modulus"):
            if key not in gauge:
                raise InputError(f"{where}: '{key}' is not stated; write {_WRITE['gauge']}")
        length = quantity(gauge["length"], "length", f"{where}.length")
        modulus = quantity(gauge["modulus"], "pressure", f"{where}.modulus")
        found = length / modulus if modulus > 0 else -1.0
    else:
        parts = _COMPLIANCE.fullmatch(str(gauge)[:_MAX_GAUGE])
        if parts is None:
            raise InputError(f"{where}: {str(gauge)[:60]!r} is not right; write {_WRITE['gauge']}")
        found = float(parts["number"]) * length_factor(parts["unit"], where)
    if found < 0:
        raise InputError(f"{where}: rock does not stretch under pressure; write it above 0")
    return found
