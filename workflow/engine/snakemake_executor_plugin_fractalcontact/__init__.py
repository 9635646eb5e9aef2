"""Jobs as forks of one process that has loaded all modules and kernels: an executor plugin.

Snakemake's own local executor starts Python for every script, which then imports modules and loads
kernels for 2.5 s of processor time. Here `multiprocessing` keeps a server that has loaded them, and
forks it for every job of one thread. A job of more threads gets a process of its own, because
libraries take their number of threads when they are loaded. The server loads while Snakemake still
reads the workflow, if `workflow/run.py` asks for it.

Without it (``make EXECUTOR=local``, ``snakemake`` without ``--executor fractalcontact``, a cluster,
any system but Linux) Snakemake starts the same scripts, with the same results to the last bit:
tests/workflow/test_executor.py.
"""

import contextlib
import multiprocessing
import os
import runpy
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import connection, forkserver
from pathlib import Path

from snakemake.iocontainers import Snakemake
from snakemake_interface_executor_plugins.executors.base import SubmittedJobInfo
from snakemake_interface_executor_plugins.executors.real import RealExecutor
from snakemake_interface_executor_plugins.settings import CommonSettings, ExecMode

from engine.ending import TOLD

common_settings = CommonSettings(
    non_local_exec=False,
    implies_no_shared_fs=False,
    job_deploy_sources=False,
    pass_envvar_declarations_to_cmd=True,
    auto_deploy_default_storage_provider=False,
)
#: Environment variable that `workflow/run.py` sets for a run that will need the server.
AHEAD = "FRACTALCONTACT_SERVER"
#: Modules that the server imports before its first job.
LOADED = [__name__, f"{__name__}.loaded"]
#: Variables from which libraries take their number of threads, as Snakemake sets them for scripts.
THREADS = ("OMP", "GOTO", "OPENBLAS", "MKL", "VECLIB_MAXIMUM", "NUMEXPR")
#: Settings of glibc: arrays of up to 256 MB reuse freed memory, of which up to 1 GB is kept. To
#: clear new pages for each array took a seventh of the time of a flow.
MEMORY = {"MALLOC_MMAP_THRESHOLD_": str(2**28), "MALLOC_TRIM_THRESHOLD_": str(2**30)}


class Executor(RealExecutor):
    """Executor of jobs on this machine."""

    def __post_init__(self):
        """Prepare the server, which the first job starts unless it runs already."""
        self.forks = multiprocessing.get_context("forkserver")
        self.forks.set_forkserver_preload(LOADED)
        self.alone = multiprocessing.get_context("spawn")
        # One thread at a time starts or joins a process, because `multiprocessing` looks at all
        # others whenever it starts one.
        self.one_by_one = threading.Lock()
        self.pool = ThreadPoolExecutor(
            self.cores + 5
        )  # as many threads as Snakemake's own executor has

    def run_job(self, job):
        """Start a job; a thread waits for its end and reports it to the scheduler."""
        is_script = not job.is_group() and job.is_script
        if is_script:
            self.workflow.async_run(job.prepare())
        ended = self.pool.submit(self._run_script if is_script else self._run_otherwise, job)
        ended.add_done_callback(lambda done: self._report(SubmittedJobInfo(job=job), done))
        self.report_job_submission(SubmittedJobInfo(job=job))

    def _run_script(self, job):
        """Exit code of the job's script."""
        folder = Path(job.rule.basedir.get_path_or_uri(secret_free=True))
        script = os.path.normpath(folder / job.rule.script)
        context = self.forks if job.threads == 1 else self.alone
        given = Snakemake(
            *(job.input, job.output, job.params, job.wildcards, job.threads, job.resources),
            *(job.log, self.workflow.config, job.rule.name, None, os.path.dirname(script)),
        )
        process = context.Process(target=run_script, args=(script, given))
        with self.one_by_one, _environment(_threads(1) | MEMORY):
            if not TOLD.is_set():
                process.start()
        if TOLD.is_set():  # the signal to end may have come before the process started
            if process.pid is None:
                return -signal.SIGTERM
            process.terminate()
        connection.wait([process.sentinel])
        with self.one_by_one:
            process.join()
            return process.exitcode

    def _run_otherwise(self, job):
        """Exit code of a job without a script, which Snakemake runs in a process of its own."""
        if not job.is_group() and job.is_norun:
            return 0
        return subprocess.run(self.format_job_exec(job), shell=True).returncode

    def _report(self, info, ended):
        # Snakemake looks for new jobs whenever a job ends. Each look starts a timer that makes it
        # look again a second later, as long as jobs wait. After 80 ended jobs it would look 80
        # times a second, and take a tenth of the paper study. The look at this end is enough.
        for thread in threading.enumerate():
            if isinstance(thread, threading.Timer):
                thread.cancel()
        if ended.exception() is None and ended.result() == 0:
            self.report_job_success(info)
        else:
            error = ended.exception()
            self.report_job_error(info, msg=f"{error!r} " if error else None)

    def shutdown(self):
        """Wait for the running jobs."""
        self.pool.shutdown()

    cancel = shutdown

    def get_exec_mode(self):
        """Execution mode of a process on this machine."""
        return ExecMode.SUBPROCESS

    def get_python_executable(self):
        """Path of the interpreter."""
        return sys.executable

    @property
    def cores(self):
        """Cores that the run may use."""
        return self.workflow.resource_settings.cores


def run_script(script: str, given: Snakemake) -> None:
    """Run a script as Snakemake does, with its job under the name ``snakemake``."""
    os.environ.update(_threads(given.threads))
    for name in MEMORY:  # read when the process started
        os.environ.pop(name, None)
    sys.argv = [script]
    sys.path.append(os.path.dirname(script))
    runpy.run_path(script, {"snakemake": given}, "__main__")


def start_server() -> None:
    """Start the server that jobs are forked from, which then loads its modules beside this."""
    multiprocessing.set_forkserver_preload(LOADED)
    with _environment(_threads(1) | MEMORY):
        forkserver.ensure_running()


def _threads(number):
    return {f"{name}_NUM_THREADS": str(number) for name in THREADS}


@contextlib.contextmanager
def _environment(told):
    """Set variables for processes that are started meanwhile."""
    before = {name: os.environ.get(name) for name in told}
    os.environ.update(told)
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


# Snakemake imports its plugins first of all. The server imports this module too, but then the
# variable is gone.
if os.environ.pop(AHEAD, None):
    start_server()
