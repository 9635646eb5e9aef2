"""An interpreter with all modules and kernels loaded, which forks for every job of a run.

    python workflow/warm.py FOLDER SOCKET

It listens on a socket, that of a folder of its own, until whoever started it closes its standard
input. ``scripts/_warm.py`` is the other end. What it saves is measured in CONTRIBUTING.md.
"""

import contextlib
import fcntl
import gc
import importlib
import json
import logging
import os
import pkgutil
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

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "src"))
#: Rooms whose modules are loaded, with all that they import; the others are so too, or rarely used.
ROOMS = (
    *("fractalcontact.cards", "fractalcontact.ensemble", "fractalcontact.figures"),
    *("fractalcontact.mechanics", "fractalcontact.pages", "fractalcontact.stages"),
    "fractalcontact.study",
    *("contactlab.experiments", "contactlab.figures"),
)
#: What Snakemake has every script import first.
FIRST_OF_SCRIPTS = "snakemake.iocontainers", "snakemake.logging"
_SOCKET = "warm"
#: What the libraries that are loaded take their number of threads from: that of a job.
ONE_THREAD = ("OMP", "GOTO", "OPENBLAS", "MKL", "VECLIB_MAXIMUM", "NUMEXPR")
#: For glibc: arrays of up to 256 MB use again what the job has freed, of which up to 1 GB is kept.
#: To clear new pages for each of them took a seventh of the time of a flow.
MEMORY = {"MALLOC_MMAP_THRESHOLD_": str(2**28), "MALLOC_TRIM_THRESHOLD_": str(2**30)}


@contextlib.contextmanager
def started() -> Iterator[str]:
    """The address of such an interpreter, which ends with the block.

    Where it cannot load a module, jobs load all by themselves, and say what is wrong.
    """
    with tempfile.TemporaryDirectory(
        prefix="fractalcontact-", ignore_cleanup_errors=True
    ) as folder:
        # Jobs that begin while it loads wait: to load everything twice would take them longer.
        with socket.socket(socket.AF_UNIX) as listener:
            # By a short name, as that of a folder may be longer than the system takes here.
            with contextlib.chdir(folder):
                listener.bind(_SOCKET)
            listener.listen(64)
            process = subprocess.Popen(
                [sys.executable, __file__, folder, str(listener.fileno())],
                env=os.environ | {f"{name}_NUM_THREADS": "1" for name in ONE_THREAD} | MEMORY,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                pass_fds=(listener.fileno(),),
                start_new_session=True,
            )
        with process:
            try:
                yield f"{folder}/{_SOCKET}"
            finally:
                process.terminate()


def main():
    """Load everything, then fork for whoever connects until standard input ends."""
    folder, listener = sys.argv[1], socket.socket(fileno=int(sys.argv[2]))
    load()
    gc.collect()
    gc.freeze()  # what is loaded stays, and forks share it: none is to go through it
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for the forks
    while sys.stdin not in select.select([listener, sys.stdin], [], [])[0]:
        connection, _ = listener.accept()
        with connection:
            if os.fork() == 0:
                listener.close()
                _work(connection)
    # Whoever started it removes the folder too, unless it was killed: then nobody else does.
    shutil.rmtree(folder, ignore_errors=True)


def load():
    """Import what jobs import, and load the kernels that were compiled."""
    from roughcontact.kernel_cache import load_cached

    for room in ROOMS:
        package = importlib.import_module(room)
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    for name in ("netCDF4", "scipy.optimize", "scipy.stats", *FIRST_OF_SCRIPTS):
        importlib.import_module(name)
    load_cached()


def _work(connection):
    """Be the job that was handed over; never return.

    What goes wrong before the number of this process is sent is said nowhere: the other end reads
    that the connection is closed, and runs the job alone.
    """
    code = 1
    try:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        _, (*standard, life), _, _ = socket.recv_fds(connection, 1, 4)
        with connection.makefile("r") as told:
            words, path, folder, environment = json.loads(told.readline())
        for number, handle in enumerate(standard):
            os.dup2(handle, number)
            os.close(handle)
        os.chdir(folder)
        os.environ.clear()
        os.environ.update(environment)
        sys.path[:], sys.argv = path, words
        # The system ends this process once the other end is closed, even inside a kernel.
        fcntl.fcntl(life, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(life, fcntl.F_SETFL, fcntl.fcntl(life, fcntl.F_GETFL) | os.O_ASYNC)
        connection.sendall(f"{os.getpid()}\n".encode())
        code = _run(words[0])
        fcntl.fcntl(life, fcntl.F_SETFL, 0)
        connection.sendall(f"{code}\n".encode())
    finally:
        # A fork must not go on in the loop of `main`, whatever was raised.
        os._exit(code)


def _run(script):
    """Exit code of a script, as Python itself would end with it."""
    code = 1
    try:
        runpy.run_path(script, run_name="__main__")
        code = 0
    except SystemExit as end:
        code = end.code or 0
        if not isinstance(code, int):
            print(code, file=sys.stderr)
            code = 1
    except BaseException:
        traceback.print_exc()
    logging.shutdown()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):
            stream.flush()
    return code & 0xFF


if __name__ == "__main__":
    main()
