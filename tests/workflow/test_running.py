"""Studies that would run code, runs that live, runs that are told to end, disks that are full."""

import os
import signal
import subprocess
import sys
import time

import pytest
import yaml
from projects import command, made, project, run, small_study, write_scan

from fractalcontact.study.sidecar import sidecar_of_matrix

__all__ = ["project"]  # a fixture
pytestmark = pytest.mark.workflow
STUDY = "config/test.yaml"


HOSTILE = {
    "template": (
        '__use_yte__: true\nstudy: \'?__import__("os").system("touch pwned")\'\n',
        "makes Snakemake run text of the file as Python",
    ),
    "tag": ("study: !!python/object/apply:os.system ['touch pwned']\n", "not readable as YAML"),
    "shell": ("study: x; touch pwned\n", "key 'study': found 'x; touch pwned', expected"),
    "substitution": ("study: a\nstudy: $(touch pwned)\n", "expected the study's name"),
    "path": ("study: ../outside\n", "expected the study's name"),
    "aliases": (
        "a: &a [1,1,1,1,1,1,1,1,1]\n"
        + "".join(
            f"{name}: &{name} [{','.join(9 * [f'*{before}'])}]\n"
            for before, name in zip("abcde", "bcdef", strict=True)
        ),
        "once its aliases",
    ),
}
#: What is found before Snakemake starts is found at once, whatever the options.
_QUICK = [("template", ()), ("shell", ("--full",)), ("aliases", ("--dry-run",))]


@pytest.mark.parametrize(
    ("kind", "options"),
    [
        *_QUICK,
        *(
            pytest.param(kind, options, marks=pytest.mark.full)
            for kind in HOSTILE
            for options in ((), ("--dry-run",), ("--full",))
            if (kind, options) not in _QUICK
        ),
    ],
)
def test_a_study_is_plain_data_and_runs_nothing(project, kind, options):
    text, said = HOSTILE[kind]
    (project / STUDY).write_text(text)
    done = made(project, STUDY, *options)
    assert done.returncode != 0
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith(f"error: {STUDY}: ")
    assert said in line
    assert not list(project.rglob("pwned"))
    assert not (project / "results").exists()


def start(project, *words):
    """A process of its own that writes what it says to a file."""
    with open(project / "said", "w") as said:
        return subprocess.Popen(
            words, cwd=project, stdout=said, stderr=subprocess.STDOUT, start_new_session=True
        )


def wait_for(path, process, seconds=300):
    end = time.monotonic() + seconds
    while not path.exists():
        assert process.poll() is None
        assert time.monotonic() < end
        time.sleep(0.02)


def made_words(*options):
    return (sys.executable, "workflow/run.py", *options, "--", "--cores", "2")


def locks(project):
    return sorted((project / ".snakemake/locks").glob("*"))


@pytest.mark.full
def test_the_lock_of_a_living_run_stays_however_it_was_started(project):
    living = start(project, *command("config/smoke.yaml"))
    wait_for(project / "results/smoke/logs/synthetic_scan", living)
    held = locks(project)
    assert held
    second = made(project, "config/smoke.yaml")
    assert second.returncode != 0
    assert second.stderr.startswith("error: another run is at work in this folder")
    assert second.stderr.count("\n") == 1
    assert living.poll() is None
    assert locks(project) == held
    os.killpg(living.pid, signal.SIGKILL)
    living.wait()
    third = made(project, "config/smoke.yaml", targets=["results/smoke/embedded/small_twin.npy"])
    assert third.returncode == 0, third.stderr[-3000:]


@pytest.mark.full
def test_jobs_that_outlive_their_run_count_as_living(project):
    """Snakemake alone killed: what its jobs still write must not mix with what a new run does."""
    living = start(project, *command("config/smoke.yaml"))
    wait_for(project / "results/smoke/logs/size_strength/surfaces.log", living)
    for job in set(_at_work(project)) - {str(living.pid)}:
        os.kill(int(job), signal.SIGSTOP)  # so that it does not end while this looks
    os.kill(living.pid, signal.SIGKILL)
    living.wait()
    refused = made(project, "config/smoke.yaml")
    assert "another run is at work" in refused.stderr
    os.killpg(living.pid, signal.SIGKILL)


@pytest.mark.full
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_a_run_that_is_told_to_end_ends_its_jobs(project, number):
    running = start(project, *made_words("config/smoke.yaml"))
    wait_for(project / "results/smoke/logs/size_strength/surfaces.log", running)
    time.sleep(0.3)
    running.send_signal(number)
    running.wait(timeout=60)
    said = (project / "said").read_text()
    assert running.returncode == 128 + number
    assert "interrupted: jobs end, and 'make' goes on from there" in said
    assert "error" not in said
    assert "Traceback" not in said
    deadline = time.monotonic() + 5
    while _at_work(project) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert _at_work(project) == []
    assert not list((project / "results").rglob(".unfinished-*"))


def _at_work(project):
    """Processes whose folder is the project's."""
    found = []
    for entry in os.listdir("/proc"):
        if entry.isdigit() and int(entry) != os.getpid():
            try:
                if os.readlink(f"/proc/{entry}/cwd") == str(project):
                    found.append(entry)
            except OSError:
                continue
    return found


@pytest.mark.full
@pytest.mark.skipif(os.geteuid() != 0, reason="only root mounts a small disk")
@pytest.mark.parametrize("megabytes", [20, 51])
def test_a_full_disk_is_said_in_one_sentence(project, megabytes):
    """Before anything runs where it is known, else by the job that meets it."""
    results = project / "results"
    results.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", results]
    mounted = subprocess.run(mount, capture_output=True, text=True)
    if mounted.returncode:
        pytest.skip(f"no tmpfs can be mounted here: {mounted.stderr.strip()}")
    try:
        small_study(project)
        write_scan(project, "rock")
        if megabytes > 50:
            # Full only once it runs: 60 kB are left.
            filler = results / "filler"
            filler.write_bytes(b"x" * (megabytes * 2**20 - 60_000))
            done = run(project, STUDY)
            assert "no space left on its disk; make room there" in done.stderr
        else:
            done = made(project, STUDY)
            (line,) = done.stderr.strip().splitlines()
            assert line.startswith("error: results: 20 MB free on its disk, less than the 50 MB")
        assert done.returncode != 0
        assert not list(results.rglob(".unfinished-*"))
        assert not list(results.rglob("*.nc"))
    finally:
        subprocess.run(["umount", results], check=True)


@pytest.mark.parametrize(
    "name",
    [
        "$(touch pwned)",
        pytest.param("a b", marks=pytest.mark.full),
        pytest.param("it's", marks=pytest.mark.full),
    ],
)
def test_an_environment_that_scripts_cannot_be_started_from_is_said_first(project, name):
    (project / name).mkdir()
    (project / name / ".venv").symlink_to(sys.prefix)
    command = [f"{name}/.venv/bin/python", "workflow/run.py", "config/smoke.yaml", "--"]
    done = subprocess.run(command, cwd=project, capture_output=True, text=True)
    assert done.returncode != 0
    (line,) = done.stderr.strip().splitlines()
    assert "Snakemake cannot start scripts from a folder whose name has spaces or quotes" in line
    assert not (project / "results").exists()


def test_results_that_cannot_be_written_to_are_said_before_anything_runs(project):
    (project / "results").write_text("a file")
    done = made(project, "config/smoke.yaml")
    assert done.stderr == "error: results: no folder that can be written to; allow it (chmod u+w)\n"


def test_a_folder_of_scans_that_is_not_there_is_one_sentence_without_the_workflow(project):
    study = small_study(project, scans="nowhere")
    done = made(project, study)
    assert done.returncode != 0
    error, end = done.stderr.splitlines()
    assert error.startswith("error: nowhere: no such folder (not mounted?); make it, name another")
    assert end.startswith("the study did not finish")
    assert done.stdout == ""
    assert not (project / "results").exists()


def test_an_empty_folder_of_scans_is_a_warning_and_a_dry_run_a_table(project):
    study = yaml.safe_load((project / "config/smoke.yaml").read_text()) | {"scans": "scans"}
    (project / STUDY).write_text(yaml.safe_dump(study))
    done = made(project, STUDY, "--dry-run", targets=["results/smoke/atlas.nc"])
    assert done.returncode == 0, done.stderr
    warning = "warning: scans: no scan files there; only what the study itself makes is used"
    assert done.stderr.splitlines() == [warning]
    *jobs, end = done.stdout.splitlines()
    assert end == f"{len(jobs)} jobs would be done; nothing was"
    assert any(
        line.startswith("  small_twin: levelled faces") and line.endswith("  not made yet")
        for line in jobs
    )
    assert max(map(len, jobs)) <= 120
    assert not (project / "results").exists()


def test_a_study_with_twins_says_how_the_scans_alone_are_computed(project):
    study = yaml.safe_load((project / "config/smoke.yaml").read_text()) | {"scans": "scans"}
    (project / STUDY).write_text(yaml.safe_dump(study))
    (project / "scans/rock.npy").touch()
    (project / "scans/rock.yaml").write_text(yaml.safe_dump(sidecar_of_matrix(0.1)))
    told = f"{STUDY} has synthetic specimens beside your scans; your scans alone: "
    own = "make STUDY=config/mine.yaml"
    for first in (f"make new, then {own}", own):
        done = made(project, STUDY, "--dry-run", targets=["results/smoke/specimens/rock.nc"])
        assert done.stderr.splitlines() == [told + first]
        (project / "config/mine.yaml").touch()


@pytest.mark.full
def test_options_that_snakemake_does_not_know_are_said_in_its_words(project):
    done = made(project, "config/smoke.yaml", targets=["--no-such-option"])
    assert done.returncode != 0
    assert "unrecognized arguments: --no-such-option" in done.stderr


@pytest.mark.full
def test_snakemake_speaks_itself_where_it_is_asked_to(project):
    done = made(project, "config/smoke.yaml", "--dry-run", "--verbose")
    assert done.returncode == 0
    assert "Job stats:" in done.stdout + done.stderr
