"""An interpreter with all modules and kernels loaded, which forks for every job of a run.

    python workflow/warm.py FOLDER SOCKET

It listens on a socket, that of a folder of its own, until whoever started it closes its standard
input. ``scripts/_warm.py`` is the other end.
"""

import contextlib
import fcntl
import gc
import importlib
import json
import logging
import os
import runpy
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "src"))
#: What the scripts of a study import, and what their functions import when they are called.
MODULES = (
    "fractalcontact.core.netcdf",
    "contactlab.experiments.size_states",
    "fractalcontact.figures.draw",
    "fractalcontact.mechanics.sweep",
    "fractalcontact.pages.explorer",
    "fractalcontact.pages.result_page",
    "fractalcontact.stages.atlas",
    "fractalcontact.stages.specimen",
    "fractalcontact.stages.states",
    "fractalcontact.stages.report",
    "fractalcontact.stages.windows",
    "fractalcontact.study.embedded",
    "fractalcontact.study.preparation",
    "netCDF4",
    "scipy.optimize",
    "scipy.stats",
)


_SOCKET = "warm"
#: What the libraries that are loaded take their number of threads from: that of a job.
ONE_THREAD = ("OMP", "GOTO", "OPENBLAS", "MKL", "VECLIB_MAXIMUM", "NUMEXPR")


@contextlib.contextmanager
def started() -> Iterator[str]:
    """The address of such an interpreter, which ends with the block.

    What is wrong with a module that it cannot load, the jobs say that need it: they then load all
    by themselves.
    """
    folder = tempfile.mkdtemp(prefix="fractalcontact-")
    try:
        process = _begun(folder)
        try:
            yield f"{folder}/{_SOCKET}"
        finally:
            process.terminate()
            process.wait()
            process.stdin.close()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _begun(folder):
    # Jobs that begin while it loads wait: to load everything twice would take them longer.
    with socket.socket(socket.AF_UNIX) as listener:
        # By a short name, as that of a folder may be longer than the system takes here.
        with contextlib.chdir(folder):
            listener.bind(_SOCKET)
        listener.listen(64)
        return subprocess.Popen(
            [sys.executable, __file__, folder, str(listener.fileno())],
            env=os.environ | {f"{name}_NUM_THREADS": "1" for name in ONE_THREAD},
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=(listener.fileno(),),
            start_new_session=True,
        )


def main():
    """Load everything, then fork for whoever connects until standard input ends."""
    folder, listener = sys.argv[1], socket.socket(fileno=int(sys.argv[2]))
    load()
    gc.collect()
    gc.freeze()  # what is loaded stays, and forks share it: none is to go through it
    _serve(listener)
    # Whoever started it removes the folder too, unless it was killed: then nobody else does.
    shutil.rmtree(folder, ignore_errors=True)


def load():
    """Import what jobs import, and load the kernels that were compiled."""
    from fractalcontact.study.figure_list import all_figures
    from roughcontact.kernel_cache import load_kept

    for name in MODULES:
        importlib.import_module(name)
    for figure in all_figures().values():
        importlib.import_module(figure.module.replace("/", "."))
    load_kept()


def _serve(listener):
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for the forks
    while True:
        ready, _, _ = select.select([listener, sys.stdin], [], [])
        if sys.stdin in ready:
            return
        connection, _ = listener.accept()
        with connection:
            if os.fork() == 0:
                listener.close()
                _work(connection)


def _work(connection):
    """Be the job that was handed over; never return.

    What goes wrong before the number of this process is sent is said nowhere: the other end reads
    that the connection is closed, and runs the job alone (``scripts/_warm.py``), which says what is
    wrong with it, if anything is. Errors of the job itself are printed by `_run`.
    """
    code = 1
    try:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        _, (*standard, life), _, _ = socket.recv_fds(connection, 1, 4)
        with connection.makefile("r") as told:
            job = json.loads(told.readline())
        for number, handle in enumerate(standard):
            os.dup2(handle, number)
            os.close(handle)
        os.chdir(job["folder"])
        os.environ.clear()
        os.environ.update(job["environment"])
        sys.path[:], sys.argv = job["path"], job["words"]
        # The system ends this process once the other end is closed, even inside a kernel.
        fcntl.fcntl(life, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(life, fcntl.F_SETFL, fcntl.fcntl(life, fcntl.F_GETFL) | os.O_ASYNC)
        connection.sendall(f"{os.getpid()}\n".encode())
        code = _run(job["words"][0])
        fcntl.fcntl(life, fcntl.F_SETFL, 0)
        connection.sendall(f"{code}\n".encode())
    finally:
        # A fork must not go on in the loop of `_serve`, whatever was raised.
        os._exit(code)


def _run(script):
    """Exit code of a script, as Python itself would end with it."""
    try:
        runpy.run_path(script, run_name="__main__")
        code = 0
    except SystemExit as end:
        code = end.code
        if code is not None and not isinstance(code, int):
            print(code, file=sys.stderr)
            code = 1
    except BaseException:
        traceback.print_exc()
        code = 1
    logging.shutdown()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):
            stream.flush()
    return int(code or 0) & 0xFF


if __name__ == "__main__":
    main()
