"""What `make` runs for its targets, with a stand-in for Python: order, study, and what it says."""

import os
import shutil
import subprocess
import sys

import pytest
from places import ROOT

#: Notes the study and its arguments, and whether another runs meanwhile.
PYTHON = """#!/bin/sh
mkdir busy || echo two at once >> calls
echo "$STUDY: $*" >> calls
sleep 0.2
rmdir busy
case "$*" in
  *compile_kernels) echo compiling kernels ;;
esac
"""


@pytest.fixture
def project(tmp_path):
    """A folder with the Makefile and a finished installation of nothing."""
    for name in ("Makefile", "benchmarks/Makefile"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    for name in ("requirements/study.lock", "pyproject.toml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    python = tmp_path / ".venv/bin/python"
    python.parent.mkdir(parents=True)
    python.write_text(PYTHON)
    python.chmod(0o755)
    (tmp_path / ".venv/installed").touch()
    return tmp_path


def make(project, *words, before="", **environment):
    """What make says, and the calls that it made; after some words of the shell."""
    outer = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "STUDY")
    kept = {name: value for name, value in os.environ.items() if name not in outer}
    done = subprocess.run(
        ["sh", "-c", f'{before}exec make "$@"', "sh", *words],
        cwd=project,
        capture_output=True,
        text=True,
        env=kept | environment,
    )
    calls = project / "calls"
    return done, calls.read_text().splitlines() if calls.exists() else []


def test_targets_run_one_after_the_other_however_many_jobs_make_may_run(project):
    done, calls = make(project, "-j8", "smoke", "report", "study")
    assert done.returncode == 0, done.stderr
    assert [call.partition(": ")[0] for call in calls] == [
        "config/smoke.yaml",
        "config/paper.yaml",
        "config/paper.yaml",
    ]
    assert calls[1].endswith(" pages")


@pytest.mark.parametrize(
    ("words", "environment", "study"),
    [
        (["smoke", "STUDY=config/mine.yaml"], {}, "config/smoke.yaml"),
        (["study", "STUDY=config/mine.yaml"], {}, "config/mine.yaml"),
        (["study"], {"STUDY": "config/mine.yaml"}, "config/mine.yaml"),
        (["size-effect-small"], {"STUDY": "config/mine.yaml"}, "config/size_effect_small.yaml"),
        (["accuracy"], {}, "config/accuracy.yaml"),
        (["accuracy", "STUDY=config/mine.yaml"], {}, "config/mine.yaml"),
        (["accuracy"], {"STUDY": "config/mine.yaml"}, "config/mine.yaml"),
    ],
)
def test_a_target_has_its_study(project, words, environment, study):
    done, calls = make(project, *words, **environment)
    assert done.returncode == 0, done.stderr
    assert calls[0].startswith(f"{study}: workflow/run.py {study} ")


def test_a_new_study_has_the_name_of_the_command_line_and_no_other(project):
    """On Windows' WSL an environment has a NAME."""
    _, calls = make(project, "new", NAME="desktop")
    _, [*_, named] = make(project, "new", "NAME=a b", SCANS="my scans")
    assert calls[-1].endswith("new_study")
    assert named.endswith("new_study --name=a b --scans my scans")


#: Targets that are refused, in one sentence.
REFUSED = [
    *(["study", "STUDY=none.yaml"], ["smoke"], ["dry-run"], ["report"], ["verify"]),
    *(["check-scans", "SCANS=none"], ["describe", "FILE=none.txt"], ["new", "NAME=a b"]),
]


@pytest.mark.parametrize("words", REFUSED, ids=" ".join)
def test_below_the_sentence_of_a_refusal_make_says_nothing_and_fails(project, words):
    with_python(project)
    done, _ = make(project, *words)
    assert done.returncode != 0
    (sentence,) = done.stderr.splitlines()
    assert sentence.startswith("error: ")


@pytest.mark.parametrize("words", [["study", "STUDY=none.yaml"], ["verify"]], ids=" ".join)
def test_where_make_takes_no_signal_it_fails_in_a_line_of_its_own(project, words):
    """Some services start everything with that of a closed pipe ignored."""
    with_python(project)
    done, _ = make(project, *words, before="trap '' PIPE; ")
    sentence, line = done.stderr.splitlines()
    assert done.returncode == 2
    assert sentence.startswith("error: ")
    assert line.startswith("make: *** [")


def with_python(project):
    """The code of this checkout in place of the stand-in."""
    shutil.copytree(ROOT / "workflow", project / "workflow")
    python = project / ".venv/bin/python"
    python.write_text(f'#!/bin/sh\nPYTHONPATH={ROOT / "src"} exec {sys.executable} "$@"\n')


def test_a_moved_or_copied_checkout_is_installed_again_before_any_target(project):
    found_in = project / ".venv/lib/python3.12/site-packages/__editable__.fractalcontact-9.pth"
    found_in.parent.mkdir(parents=True)
    for folder, again in ((project, False), (project.with_name("moved"), True)):
        found_in.write_text(f"{folder}/src\n")
        for target in ("study", "verify", "check-scans", "describe", "new", "dry-run"):
            (project / "calls").unlink(missing_ok=True)
            _, calls = make(project, target)
            assert any(call.endswith("--no-index -e .") for call in calls[:-1]) == again, target


def test_an_installation_says_once_that_kernels_are_compiled(project):
    (project / ".venv/installed").unlink()
    done, calls = make(project, ".venv/installed")
    assert done.returncode == 0, done.stderr
    assert sum("compile_kernels" in call for call in calls) == 1
    said = [line for line in done.stdout.splitlines() if "kernels" in line]
    assert said == ["compiling kernels"]
