"""A job handed over to a fork of an interpreter that has all modules and kernels loaded.

The interpreter is ``workflow/warm.py``; where none listens, as on a cluster or where Snakemake was
started without `make`, the job goes on here as if this did not exist. What Snakemake started stays,
and stands for the fork: it ends as that ends, a signal to it is passed on, and the fork does not
outlive it.
"""

import contextlib
import json
import os
import signal
import socket
import sys

#: Where the address of the interpreter stands.
ADDRESS = "FRACTALCONTACT_WARM"
#: Where Snakemake states the threads of a job. Only those of one are handed over: the interpreter
#: has loaded its libraries for one.
THREADS = "OMP_NUM_THREADS"
_PASSED_ON = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT)


def hand_over():
    """Let a fork run the script of this process and end as it does; return where there is none."""
    environment = dict(os.environ)
    address = environment.pop(ADDRESS, "")
    if not address or environment.get(THREADS) != "1":
        return
    # Until the fork is known a signal waits: it would end this process and not be passed on.
    signal.pthread_sigmask(signal.SIG_BLOCK, _PASSED_ON)
    job = [sys.argv, sys.path, os.getcwd(), environment]
    life, alive = os.pipe()  # open for as long as this process lives, and no longer
    with socket.socket(socket.AF_UNIX) as connection, connection.makefile("r") as told:
        try:
            connection.connect(address)
            socket.send_fds(connection, [b"\n"], [0, 1, 2, life])
            connection.sendall(json.dumps(job).encode() + b"\n")
            number = told.readline()
        except OSError:  # there is none, or it ended without having read all of it
            number = ""
        os.close(life)
        if number.endswith("\n"):
            for passed in _PASSED_ON:
                signal.signal(passed, lambda received, frame: _pass_on(int(number), received))
            signal.pthread_sigmask(signal.SIG_UNBLOCK, _PASSED_ON)
            code = told.readline()
            # Without a word: killed, and so this is too, that Snakemake says so.
            os._exit(int(code) if code else 128 + signal.SIGKILL)
    # It ended before it began: nothing has been run.
    os.close(alive)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _PASSED_ON)


def _pass_on(process, number):
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, number)
