"""Laboratory tests of a specimen, stated by its sidecar or the study under ``measured``.

A measured curve means little without what its displacement contains, its seat, branch and cycle:
a test that lacks one of them is refused with what to write.
"""

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.keys import Section
from ..core.settings import TEST_COLUMNS, MeasuredTest
from .laboratory_keys import Tests
from .scan_files import refuse_outside_link


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


def resolve_tests(stated: Tests | None, where: str, folder: Path) -> list[MeasuredTest]:
    """Tests of a specimen in mm and MPa, their files in a folder.

    Raises
    ------
    InputError
        If a test contradicts itself or another label.
    """
    tests = [
        _resolved(kind, test, f"{where}.{kind}", folder)
        for kind in TEST_COLUMNS
        for test in getattr(stated, kind, ())
    ]
    labels = [(test.kind, test.label) for test in tests]
    if twice := next((label for label in labels if labels.count(label) > 1), None):
        raise InputError(
            f"{where}.{twice[0]}: two tests are '{twice[1]}'; keep one, or state another 'cycle'"
        )
    if sum(bool(test.calibrate) for test in tests) > 1:
        raise InputError(
            f"{where}: two tests calibrate a constant; keep 'calibrate' in one, so that the others "
            "are predicted"
        )
    if sum(math.isfinite(test.datum_pressure) for test in tests) > 1:
        raise InputError(
            f"{where}.flow: two tests state 'datum_pressure'; keep it in one, so that the others "
            "are predicted"
        )
    return tests


def require_files(tests: Iterable[MeasuredTest]) -> None:
    """Refuse tests whose file is missing, or a link out of its folder."""
    for path in (Path(test.file) for test in tests):
        if not path.exists():
            raise InputError(f"{path}: no such file, which 'measured' names; put it there")
        refuse_outside_link(path, path.parent)


def _resolved(kind: str, test: Section, where: str, folder: Path) -> MeasuredTest:
    values = dict(test)
    wanted, columns = TEST_COLUMNS[kind], values["columns"]
    if kind == "flow" and "hydraulic_aperture" in columns:
        wanted = (wanted[0], "hydraulic_aperture")
    if odd := sorted(columns.keys() - set(wanted)):
        raise InputError(
            f"{where}.columns: no column '{odd[0]}' of a {kind} test; expected {', '.join(wanted)}"
        )
    values["columns"] = {name: columns.get(name, name) for name in wanted}
    values["file"] = str(folder / values["file"])
    resolved = MeasuredTest(kind, compliance=values.pop("gauge", 0.0), **values)
    branch, cycle = resolved.branch, resolved.cycle
    if (branch, cycle > 1) in (("load", True), ("reload", False)):
        raise InputError(
            f"{where}: 'branch: {branch}' in cycle {cycle}; the first loading is 'branch: load' of "
            "cycle 1, any later one 'branch: reload' of cycle 2 or more"
        )
    return resolved
