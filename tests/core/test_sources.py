"""Which files code follows from, found as the parser of Python finds them, and their digest."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from parsed_imports import parsed_files

import fractalcontact
from fractalcontact.core import sources

PACKAGE = Path(fractalcontact.__file__).parent
SCRIPTS = PACKAGE.parents[1] / "workflow/scripts"
CODE = sorted(PACKAGE.rglob("*.py"))


@pytest.mark.parametrize("path", [*CODE, *sorted(SCRIPTS.glob("*.py"))], ids=lambda path: path.stem)
def test_files_are_those_that_the_parser_finds(path):
    assert sources.source_files([path], package=PACKAGE) == parsed_files(path, PACKAGE)


@pytest.fixture
def project(tmp_path):
    """A package with an inner one, and a script with a helper, every file still empty."""
    for name in ("rocks/inner", "scripts"):
        (tmp_path / name).mkdir(parents=True)
    for name in (
        *("rocks/__init__", "rocks/a", "rocks/b", "rocks/c", "rocks/numpy"),
        *("rocks/inner/__init__", "rocks/inner/d", "rocks/inner/e", "scripts/job", "scripts/_help"),
    ):
        (tmp_path / f"{name}.py").write_text("")
    return tmp_path


def files_of(project, name):
    """What a file follows from, besides itself and the packages' own files."""
    found = sources.source_files([project / f"{name}.py"], package=project / "rocks")
    names = {path.relative_to(project).with_suffix("").as_posix() for path in found}
    return sorted(names - {name, "rocks/__init__", "rocks/inner/__init__"})


@pytest.mark.parametrize(
    ("name", "text", "found"),
    [
        ("rocks/a", "from . import b, c\n", "rocks/b rocks/c"),
        ("rocks/a", "from . import b as other, c as third  # both\n", "rocks/b rocks/c"),
        ("rocks/a", "from .b import (\n    one,  # (this)\n    two,\n)\n", "rocks/b"),
        ("rocks/a", "from . import (\n    b,  # (this)\n    c,\n)\n", "rocks/b rocks/c"),
        ("rocks/a", "from . import b, \\\n    c\n", "rocks/b rocks/c"),
        ("rocks/a", "from . import b\r\nfrom . import c\r\n", "rocks/b rocks/c"),
        ("rocks/a", "def f():\n    from .b import one\n\n    return one\n", "rocks/b"),
        ("rocks/a", "from .b import *\nfrom .c import one", "rocks/b rocks/c"),
        ("rocks/a", "from .inner import d\n", "rocks/inner/d"),
        ("rocks/a", "from .inner.d import one\n", "rocks/inner/d"),
        ("rocks/a", "import rocks.inner.d as x, rocks.b\n", "rocks/b rocks/inner/d"),
        ("rocks/inner/d", "from ..b import one\n", "rocks/b"),
        ("rocks/inner/d", "from .. import b\n", "rocks/b"),
        ("rocks/inner/d", "from . import e\n", "rocks/inner/e"),
        ("rocks/a", "from . import inner\n\nmodules_of(inner)\n", "rocks/inner/d rocks/inner/e"),
        ("rocks/a", "from . import inner\n\nmodules_of(b)\n", ""),
        ("rocks/inner/d", "from rocks.c import one\n", "rocks/c"),
        ("scripts/job", "from rocks import b\n", "rocks/b"),
        ("scripts/job", "from rocks.inner import d\n", "rocks/inner/d"),
        ("scripts/job", "from _help import one\n", "scripts/_help"),
        ("scripts/job", "import os\nimport _help\n", "scripts/_help"),
        # A module of a package does not import what lies beside it without a dot.
        ("rocks/a", "import numpy\n", ""),
        ("rocks/a", '"""Nothing of this\nfrom . import b is meant.\n"""\n', ""),
        ("rocks/a", "# from . import b\n", ""),
    ],
)
def test_every_way_to_import_is_followed(project, name, text, found):
    (project / f"{name}.py").write_bytes(text.encode())
    assert files_of(project, name) == found.split()


def test_far_imports_and_those_of_packages_on_the_way_count(project):
    (project / "scripts/job.py").write_text("from rocks.inner.d import one\n")
    (project / "rocks/inner/d.py").write_text("from . import e\n")
    (project / "rocks/inner/__init__.py").write_text("from ..a import one\n")
    (project / "rocks/__init__.py").write_text("from .b import one\n")
    assert files_of(project, "scripts/job") == ["rocks/a", "rocks/b", *_inner("d", "e")]
    files = sources.source_files([project / "scripts/job.py"], package=project / "rocks")
    assert project / "rocks/inner/__init__.py" in files
    assert files == sorted(files)


def _inner(*names):
    return [f"rocks/inner/{name}" for name in names]


def test_names_that_a_package_imports_when_first_asked_lead_to_their_module(project):
    (project / "rocks/__init__.py").write_text(
        '_HOMES = {\n    "one": ".b",\n    "two": ".c",\n}\n'
    )
    (project / "scripts/job.py").write_text("from rocks import one\n")
    assert files_of(project, "scripts/job") == ["rocks/b"]
    (project / "scripts/job.py").write_text("import rocks\n")
    assert files_of(project, "scripts/job") == []


def test_every_module_of_a_listed_folder_counts(project):
    """Readers, estimators and others are found by listing the folder they lie in."""
    (project / "rocks/a.py").write_text(
        "from . import c, inner\nfrom .b import modules_of\nALL = modules_of(inner)\n"
    )
    assert files_of(project, "rocks/a") == ["rocks/b", "rocks/c", *_inner("d", "e")]
    (project / "rocks/inner/f.py").write_text("from ..numpy import one\n")
    assert files_of(project, "rocks/a") == [
        "rocks/b",
        "rocks/c",
        *_inner("d", "e", "f"),
        "rocks/numpy",
    ]
    (project / "rocks/a.py").write_text("from . import inner\n")
    assert files_of(project, "rocks/a") == []


def test_circles_end(project):
    (project / "rocks/a.py").write_text("from . import b\n")
    (project / "rocks/b.py").write_text("from . import a\n")
    assert files_of(project, "rocks/a") == ["rocks/b"]


def test_a_file_that_changes_within_a_process_is_read_again(project):
    path = project / "rocks/a.py"
    for name in "bcbc":
        path.write_text(f"from . import {name}\n")
        os.utime(path, (1e9, 1e9))
        assert files_of(project, "rocks/a") == [f"rocks/{name}"]


def test_the_package_follows_from_itself_alone():
    assert sources.source_files(CODE, package=PACKAGE) == CODE


def test_nothing_heavy_is_imported_for_it():
    heavy = "{'ast', 'numpy', 'numba', 'xarray', 'snakemake', 'importlib.metadata'}"
    code = f"import sys, fractalcontact.core.sources; print({heavy} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_the_digest_follows_content_names_and_versions_not_the_place(project, tmp_path_factory):
    files = sorted((project / "rocks").glob("*.py"))
    before = sources.digest(files, root=project)
    assert len(before) == 16
    assert int(before, 16) >= 0
    assert sources.digest(files[::-1] + files[:1], root=str(project)) == before
    moved = tmp_path_factory.mktemp("moved")
    (project / "rocks").rename(moved / "rocks")
    assert sources.digest([moved / f.relative_to(project) for f in files], root=moved) == before
    (moved / "rocks").rename(project / "rocks")

    others = [
        sources.digest(files[1:], root=project),
        sources.digest(files, root=project.parent),
        sources.digest(files, root=project, versions={"numpy": "2.4"}),
        sources.digest(files, root=project, versions={"numpy": "2.5"}),
    ]
    (project / "rocks/a.py").write_text("\n")
    others.append(sources.digest(files, root=project))
    (project / "rocks/a.py").write_text("")
    (project / "rocks/b.py").rename(project / "rocks/other.py")
    others.append(sources.digest(sorted((project / "rocks").glob("*.py")), root=project))
    assert len({before, *others}) == len(others) + 1
    versions = {"a": "1", "b": "2"}
    assert sources.digest([], root=project, versions=versions) == sources.digest(
        [], root=project, versions=dict(reversed(versions.items()))
    )


def test_a_file_outside_the_root_is_refused(project):
    with pytest.raises(ValueError, match=r"job\.py: not below .*rocks"):
        sources.digest([project / "scripts/job.py"], root=project / "rocks")
