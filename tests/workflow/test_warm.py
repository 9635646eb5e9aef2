"""Jobs that a warm interpreter forks: they do, say and end as those that start alone."""

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

import pytest
from places import ROOT
from projects import made, project, run, small_study, write_scan

__all__ = ["project"]  # a fixture
sys.path.append(str(ROOT / "workflow"))
import warm

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="jobs are forks on Linux alone")


@pytest.fixture(scope="module")
def address():
    with warm.started() as address:
        yield address


def start(folder, text, address, **environment):
    """A script as Snakemake starts one, with its standard error in a file."""
    script = folder / ".snakemake/scripts/script.py"
    script.parent.mkdir(parents=True, exist_ok=True)
    script.write_text(f"import sys\n{text}")
    told = {"FRACTALCONTACT_WARM": address, "OMP_NUM_THREADS": "1"} | environment
    told["PYTHONPATH"] = str(ROOT / "workflow/scripts")
    with open(folder / "said", "w") as said:
        return subprocess.Popen(
            [sys.executable, script, "a word"],
            cwd=folder,
            env=os.environ | told,
            stdout=subprocess.PIPE,
            stderr=said,
            text=True,
        )


TOLD = """
import json, os
print(json.dumps([sys.argv[1:], os.getcwd(), os.environ.get("ASKED"), os.getpid(),
      "fractalcontact.figures.draw" in sys.modules, "FRACTALCONTACT_WARM" in os.environ]))
"""


def test_a_fork_has_the_words_folder_and_environment_of_its_job(tmp_path, address):
    job = start(tmp_path, TOLD, address, ASKED="yes")
    words, folder, asked, number, is_warm, again = json.loads(job.communicate()[0])
    assert (words, folder, asked) == (["a word"], str(tmp_path), "yes")
    assert number != job.pid
    assert is_warm
    assert not again
    assert job.returncode == 0


@pytest.mark.parametrize("reads", [False, True])
def test_a_job_whose_fork_ends_before_it_begins_runs_alone(tmp_path, reads):
    folder = tempfile.mkdtemp()  # short, as the address of a socket must be
    try:
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(f"{folder}/warm")
            listener.listen()
            job = start(tmp_path, TOLD, f"{folder}/warm", ASKED="yes")
            listener.settimeout(60)
            connection, _ = listener.accept()
            with connection, connection.makefile("rb") as told:
                for _ in range(2 * reads):
                    told.readline()
            words, _, asked, number, *_ = json.loads(job.communicate(timeout=60)[0])
    finally:
        shutil.rmtree(folder)
    assert (words, asked, number, job.returncode) == (["a word"], "yes", job.pid, 0)


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        ("sys.exit('error: in one sentence')", 1, "error: in one sentence\n"),
        ("sys.exit(3)", 3, ""),
        ("sys.exit()", 0, ""),
        ("raise ValueError('of the program')", 1, "ValueError: of the program\n"),
        ("import os; os.kill(os.getpid(), 9)", 128 + 9, ""),
    ],
)
def test_a_job_ends_as_its_fork_does(tmp_path, address, text, code, said):
    job = start(tmp_path, text, address)
    job.communicate(timeout=60)
    assert job.returncode == code
    assert (tmp_path / "said").read_text().endswith(said)
    assert bool(said) == bool((tmp_path / "said").read_text())


@pytest.mark.parametrize("changed", [{"OMP_NUM_THREADS": "2"}, {"FRACTALCONTACT_WARM": "/none"}])
def test_without_one_or_with_more_threads_a_job_goes_on_alone(tmp_path, address, changed):
    job = start(tmp_path, TOLD, address, **changed)
    *_, number, is_warm, _ = json.loads(job.communicate()[0])
    assert number == job.pid
    assert not is_warm


WAITS = """
import os, signal, time
def stop(number, frame):
    print("stopped", flush=True)
    sys.exit(143)
signal.signal(signal.SIGTERM, stop)
print(os.getpid(), flush=True)
time.sleep(60)
"""


def test_a_signal_is_passed_on(tmp_path, address):
    job = start(tmp_path, WAITS, address)
    job.stdout.readline()
    job.send_signal(signal.SIGTERM)
    assert job.communicate(timeout=20)[0] == "stopped\n"
    assert job.returncode == 143


COMPUTES = """
import os, numba
@numba.njit
def busy(n):
    x = 0.0
    for i in range(n):
        x += i % 7 / (i + 1.5)
    return x
busy(10)
print(os.getpid(), flush=True)
busy(10**12)
"""


@pytest.mark.parametrize("text", [WAITS, COMPUTES])
def test_a_fork_does_not_outlive_its_job(tmp_path, address, text):
    """Not even one that is inside a kernel, where no Python code runs."""
    job = start(tmp_path, text, address)
    fork = int(job.stdout.readline())
    job.kill()
    deadline = time.monotonic() + 20
    while _lives(fork) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not _lives(fork)


def _lives(number):
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    return True


def test_an_interpreter_ends_with_whoever_started_it(tmp_path):
    text = (
        f"import sys, time; sys.path.insert(0, {str(ROOT / 'workflow')!r}); import warm\n"
        "with warm.started() as address:\n    print(address, flush=True)\n    time.sleep(60)\n"
    )
    owner = subprocess.Popen(
        [sys.executable, "-c", text], stdout=subprocess.PIPE, text=True, cwd=tmp_path
    )
    address = owner.stdout.readline().strip()
    owner.kill()
    owner.communicate()
    deadline = time.monotonic() + 60
    while os.path.exists(os.path.dirname(address)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not os.path.exists(os.path.dirname(address))


@pytest.mark.full
@pytest.mark.workflow
def test_a_study_has_the_same_bytes_with_and_without(project):
    small_study(project)
    write_scan(project, "rock")
    alone = run(project, "config/test.yaml", "atlas")
    assert alone.returncode == 0, alone.stderr[-3000:]
    atlas = project / "results/test/atlas.nc"
    expected = atlas.read_bytes()
    shutil.rmtree(project / "results")
    done = made(project, "config/test.yaml", targets=["atlas"])
    assert done.returncode == 0, done.stderr[-3000:]
    assert atlas.read_bytes() == expected
