"""Jobs as forks of one process: they get, say and end as those that Snakemake starts itself."""

import json
import os
import signal
import sys
import threading
from concurrent.futures import Future
from types import SimpleNamespace

import pytest
from places import ROOT
from snakemake.iocontainers import InputFiles, Log, OutputFiles, Params

sys.path += [str(ROOT / "workflow"), str(ROOT / "workflow/engine")]
import snakemake_executor_plugin_fractalcontact as forks

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="jobs are forks on Linux alone")


@pytest.fixture(scope="module")
def executor():
    paths = [str(ROOT / name) for name in ("src", "workflow", "workflow/engine")]
    os.environ["PYTHONPATH"] = os.pathsep.join(paths)
    resources = SimpleNamespace(resource_settings=SimpleNamespace(cores=2))
    workflow = SimpleNamespace(
        **vars(resources), executor_settings=None, main_snakefile="", dag=None, scheduler=None
    )
    workflow.config, workflow.async_run = {"study": "test"}, lambda awaited: None
    one = forks.Executor(workflow, None)
    yield one
    one.shutdown()
    del os.environ["PYTHONPATH"]


def end_of(executor, folder, text, threads=1):
    """Exit code of a script, run as that of a job."""
    (folder / "script.py").write_text(text)
    basedir = SimpleNamespace(get_path_or_uri=lambda secret_free: str(folder))
    lists = {
        "input": InputFiles([str(folder / "told.json")]),
        "output": OutputFiles(),
        "log": Log(),
        "params": Params(),
    }
    job = SimpleNamespace(
        rule=SimpleNamespace(basedir=basedir, script="script.py", name="a_rule"),
        threads=threads,
        wildcards={},
        resources={},
        **lists,
    )
    return executor._run_script(job)


TOLD = """
import json, os, sys
with open(snakemake.input[0], "w") as file:
    json.dump([snakemake.rule, snakemake.config, os.getcwd(), os.environ["OMP_NUM_THREADS"],
               "fractalcontact.figures.draw" in sys.modules,
               "MALLOC_TRIM_THRESHOLD_" in os.environ], file)
"""


@pytest.mark.parametrize("threads", [1, 2])
def test_a_script_is_given_its_job_and_of_one_thread_finds_everything_loaded(
    executor, tmp_path, threads
):
    assert end_of(executor, tmp_path, TOLD, threads) == 0
    told = json.loads((tmp_path / "told.json").read_text())
    loaded = threads == 1
    assert told == ["a_rule", {"study": "test"}, os.getcwd(), str(threads), loaded, False]


def test_jobs_of_one_thread_are_forks_of_one_interpreter(executor, tmp_path):
    """However many jobs a run has; a job of more threads starts an interpreter of its own."""
    parents = []
    for threads in (1, 1, 2):
        script = "import os; open(snakemake.input[0], 'w').write(str(os.getppid()))"
        assert end_of(executor, tmp_path, script, threads) == 0
        parents.append(int((tmp_path / "told.json").read_text()))
    server, again, own = parents
    assert server == again
    assert own == os.getpid() != server


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("import sys; sys.exit('error: in one sentence')", 1),
        ("import sys; sys.exit(3)", 3),
        ("import sys; sys.exit()", 0),
        ("raise ValueError('of the program')", 1),
        ("import os; os.kill(os.getpid(), 9)", -9),
    ],
)
def test_a_job_has_the_exit_code_of_its_script(executor, tmp_path, text, code):
    assert end_of(executor, tmp_path, text) == code


def test_no_job_is_begun_once_the_run_was_told_to_end(executor, tmp_path, monkeypatch):
    told = threading.Event()
    told.set()
    monkeypatch.setattr(forks, "TOLD", told)
    assert end_of(executor, tmp_path, TOLD) == -signal.SIGTERM
    assert not (tmp_path / "told.json").exists()


def test_a_job_is_ended_whose_run_was_told_to_end_while_it_began(executor, tmp_path, monkeypatch):
    told = SimpleNamespace(is_set=iter([False, True]).__next__)
    monkeypatch.setattr(forks, "TOLD", told)
    assert end_of(executor, tmp_path, "import time; time.sleep(600)") == -signal.SIGTERM


def test_the_variables_of_a_start_are_gone_after_it(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MALLOC_TRIM_THRESHOLD_", raising=False)
    with forks._environment(forks._threads(1) | forks.MEMORY):
        assert os.environ["OMP_NUM_THREADS"] == "1"
        assert "MALLOC_TRIM_THRESHOLD_" in os.environ
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MALLOC_TRIM_THRESHOLD_" not in os.environ


def test_an_ended_job_leaves_no_timer_of_the_scheduler(executor, monkeypatch):
    """Timers would add up, one for each ended job, and each has the scheduler look every second."""
    ends = []
    monkeypatch.setattr(executor, "report_job_success", ends.append)
    timers = [threading.Timer(600, ends.append, ["looked"]) for _ in range(3)]
    for timer in timers:
        timer.start()
    ended = Future()
    ended.set_result(0)
    executor._report("the job", ended)
    for timer in timers:
        timer.join(60)
        assert not timer.is_alive()
    assert ends == ["the job"]
