"""The code that counts for a job: all that it imports, by rooms, and nothing of rooms above."""

import subprocess
import sys
from pathlib import Path

import pytest
from parsed_imports import parsed_files
from places import ROOT

sys.path.append(str(ROOT / "workflow"))
from engine.code_digest import Code

SRC, SCRIPTS = ROOT / "src", sorted((ROOT / "workflow/scripts").glob("[a-z]*.py"))
MODULES = sorted((SRC / "fractalcontact/stages").glob("[a-z]*.py"))
CODE = Code(SRC, ROOT, ROOT / "workflow")


@pytest.mark.parametrize("path", [*SCRIPTS, *MODULES], ids=lambda path: path.stem)
def test_all_that_the_parser_finds_counts(path):
    assert set(map(str, parsed_files(path, SRC / "fractalcontact"))) <= CODE.files_behind(path)


def test_a_new_law_of_closure_area_or_strength_solves_nothing_again():
    behind = CODE.files_behind(ROOT / "workflow/scripts/contact.py")
    assert any("/states/" in file for file in behind)
    assert not any("/laws/" in file for file in behind)


def test_code_of_a_script_follows_from_the_function_that_it_calls():
    paths = CODE.files_behind(ROOT / "workflow/scripts/windows.py")
    files = {Path(path).relative_to(ROOT).as_posix() for path in paths}
    rooms = {file.split("/")[2] for file in files if file.count("/") > 2}
    assert {"workflow/engine/job.py", "workflow/scripts/_files.py"} <= files
    assert "src/fractalcontact/stages/windows.py" in files
    assert {"size_effect", "contact", "states"} <= rooms
    # Another stage does not make it again, nor do rooms above.
    assert not {"study", "figures", "pages"} & rooms
    assert "src/fractalcontact/stages/strength.py" not in files


def test_all_that_a_stage_has_loaded_when_it_is_called_counts():
    code = (
        "import sys, fractalcontact.stages.windows\n"
        "print(*(m.__file__ for n, m in sys.modules.items() if n.startswith('fractalcontact')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {Path(name).relative_to(SRC) for name in done.stdout.split()}
    assert len(loaded) > 50
    found = CODE.files_behind(SRC / "fractalcontact/stages/windows.py")
    assert loaded <= {Path(name).relative_to(SRC) for name in found}


@pytest.fixture
def project(tmp_path):
    """A package of three rooms, each importing from the one below, and scripts beside it."""
    files = {
        "src/rocks/__init__.py": "",
        "src/rocks/high/__init__.py": "",
        "src/rocks/high/a.py": "from .b import one\nfrom ..middle.c import two\n",
        "src/rocks/high/b.py": "",
        "src/rocks/high/other.py": "from ..aside.e import one\n",
        "src/rocks/middle/c.py": "def f():\n    from ..low import d\n",
        "src/rocks/middle/table.yaml": "x: 1\n",
        "src/rocks/middle/inner/deep.py": "from ...aside import e\n",
        "src/rocks/low/d.py": "import numpy as np\n",
        "src/rocks/aside/e.py": "",
        "src/rocks/top/f.py": "from ..high.a import one\n",
        "scripts/job.py": "from _help import one\n\nfrom rocks.high.a import two\n",
        "scripts/_help.py": "import yaml\n",
        "tests/test_a.py": "from rocks.high.a import one\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def digest(project, *names):
    return Code(project / "src", project).digest(*(names or [project / "scripts/job.py"]))


def behind(project, *names):
    found = Code(project / "src", project).files_behind(*(names or [project / "scripts/job.py"]))
    return {Path(path).relative_to(project).as_posix() for path in found}


def test_own_files_count_one_by_one_and_rooms_below_whole(project):
    assert behind(project) == {
        *("scripts/job.py", "scripts/_help.py", "src/rocks/__init__.py"),
        *(f"src/rocks/high/{name}.py" for name in ("__init__", "a", "b")),
        *(f"src/rocks/middle/{name}" for name in ("c.py", "table.yaml", "inner/deep.py")),
        *("src/rocks/low/d.py", "src/rocks/aside/e.py"),
    }


def test_a_room_is_named_whole_and_a_name_of_the_package_may_be_any(project):
    of_room = behind(project, "rocks/high")
    assert {"src/rocks/high/other.py", "src/rocks/low/d.py"} <= of_room
    assert "src/rocks/top/f.py" not in of_room
    (project / "scripts/job.py").write_text("from rocks import two\n")
    assert {"src/rocks/top/f.py", "src/rocks/high/other.py"} <= behind(project)


@pytest.mark.parametrize(
    ("name", "counts"),
    [
        ("scripts/_help.py", True),
        ("scripts/job.py", True),
        ("src/rocks/middle/table.yaml", True),
        ("src/rocks/middle/new.py", True),  # found by listing its folder
        ("src/rocks/high/b.py", True),
        ("src/rocks/high/other.py", False),  # a stage of its own
        ("src/rocks/top/f.py", False),  # above
        ("src/rocks/middle/__pycache__/c.pyc", False),
        ("tests/test_a.py", False),
    ],
)
def test_a_change_of_what_counts_and_of_nothing_else_is_seen(project, name, counts):
    before = digest(project)
    (project / name).parent.mkdir(exist_ok=True)
    with open(project / name, "a") as file:
        file.write("# a change\n")
    assert (digest(project) != before) == counts


def test_a_moved_checkout_is_the_same_and_a_renamed_file_another(project, tmp_path_factory):
    before = digest(project)
    moved = tmp_path_factory.mktemp("moved") / "it"
    project.rename(moved)
    assert digest(moved) == before
    (moved / "src/rocks/middle/c.py").rename(moved / "src/rocks/middle/g.py")
    assert digest(moved) != before


def test_a_file_moved_to_another_folder_is_another(project):
    before = digest(project)
    table = project / "src/rocks/middle/table.yaml"
    table.rename(table.parent / "inner" / table.name)
    assert digest(project) != before


def test_what_runs_before_a_module_counts_though_it_imports_nothing(project):
    """That of the package and of its room."""
    (project / "scripts/alone.py").write_text("from rocks.high.b import one\n")
    assert behind(project, project / "scripts/alone.py") == {
        "scripts/alone.py",
        *("src/rocks/__init__.py", "src/rocks/high/__init__.py", "src/rocks/high/b.py"),
    }
    (project / "src/rocks/high/inner").mkdir()
    (project / "src/rocks/high/inner/g.py").write_text("")
    (project / "scripts/alone.py").write_text("from rocks.high.inner.g import one\n")
    assert "src/rocks/high/__init__.py" in behind(project, project / "scripts/alone.py")
    (project / "scripts/alone.py").write_text("from rocks.low import d\n")
    assert "src/rocks/__init__.py" in behind(project, project / "scripts/alone.py")


def test_versions_of_libraries_count_where_they_are_imported(project, monkeypatch):
    found = Code(project / "src", project)
    versions = found.versions(found.files_behind(project / "scripts/job.py"))
    assert versions.keys() == {"numpy", "yaml"}
    before = digest(project)
    monkeypatch.setattr(Code, "versions", lambda self, files: versions | {"numpy": "another"})
    assert digest(project) != before
    with_kernels = project / "src/rocks/low/d.py"
    monkeypatch.undo()
    with_kernels.write_text("import numba\n")
    assert {"numba", "llvmlite"} <= Code(project / "src", project).versions(
        [str(with_kernels)]
    ).keys()


def test_circles_end(project):
    (project / "src/rocks/low/d.py").write_text("from ..middle import c\n")
    assert "src/rocks/low/d.py" in behind(project)


def test_reading_the_workflow_imports_nothing_heavy_for_it():
    heavy = "{'ast', 'numpy', 'numba', 'xarray', 'snakemake', 'importlib.metadata'}"
    code = f"import sys, engine.code_digest; print({heavy} & set(sys.modules))"
    words, folder = [sys.executable, "-c", code], ROOT / "workflow"
    done = subprocess.run(words, capture_output=True, text=True, check=True, cwd=folder)
    assert done.stdout.strip() == "set()"
