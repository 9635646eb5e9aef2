"""Scan files are untrusted input: each is read in a process of its own, within limits.

A library that meets a damaged or hostile file may hang, take all memory or crash. It then does so
in a fork of the reader process (`reader_process`), and the user gets one clear error.
"""

import atexit
import json
import logging
import os
import signal
import socket
import subprocess
import sys
import threading
from multiprocessing.connection import Connection
from multiprocessing.reduction import recv_handle
from pathlib import Path

from ..core.errors import InputError
from . import reader_process
from .options import ScanOptions
from .raw import IncompleteSidecar, RawScan
from .transfer import from_text, receive_scan, to_text

#: The reader process finds the same packages as this one, wherever they come from.
_START = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
    f"from {reader_process.__name__} import serve; serve()"
)
_LIKELY = "the file is damaged, hostile or far too large; export it again, or a part of it"

_lock = threading.Lock()
_server = None


class ReaderBug(RuntimeError):
    """Unexpected error of a reader, with its traceback in the notes."""


def read_confined(path: Path, options: ScanOptions) -> RawScan:
    """Content of a regular file, read in a process with bounded memory, time and files.

    A reader that refuses the file, crashes or goes beyond its limits raises `InputError`; any other
    exception of a reader is a `ReaderBug`.
    """
    # The reader process may run in another folder.
    folder = "/" if path.is_absolute() else os.getcwd()
    request = {"path": str(path), "folder": folder, "options": options.stated()}
    lines, raw, status = _ask(request, path)
    limits: dict = next((line for line in reversed(lines) if line["outcome"] == "limits"), {})
    last = lines[-1] if lines else {"outcome": "limits"}
    if raw is not None and status == 0:
        return raw
    if last["outcome"] == "incomplete":
        raise IncompleteSidecar(last["message"], last["draft"])
    if last["outcome"] == "refused":
        raise InputError(last["message"])
    if last["outcome"] == "bug":
        bug = ReaderBug(f"{path}: {last['message']}")
        bug.add_note(last["traceback"])
        raise bug
    raise InputError(f"{path}: {_how_it_ended(last['outcome'], status, limits)}; {_LIKELY}")


def _how_it_ended(outcome: str, status: int, limits: dict) -> str:
    """Fate of a reader that sent no result, in words."""
    if outcome == "memory":
        return f"the reader ran out of memory ({limits['memory'] / 1024**3:.1f} GiB allowed)"
    if not os.WIFSIGNALED(status):
        return "the reader ended without a result"
    number = os.WTERMSIG(status)
    if number == signal.SIGXCPU:
        return f"reading took longer than {limits['processor_seconds']} s of processor time"
    if number == signal.SIGALRM:
        return f"reading took longer than {limits['seconds']} s"
    return f"the reader crashed (signal {number})"


def _ask(request: dict, path: Path):
    """Read in the reader process, which is started if needed."""
    global _server
    with _lock:
        if _server is None or not _server.is_alive():
            _server = _Server()
        try:
            return _server.read(request, path)
        except BaseException:  # after Ctrl-C the rest of this answer would pass for the next one
            stop_reader()
            raise


@atexit.register
def stop_reader() -> None:
    """End the reader process; the next file starts another one."""
    global _server
    if _server is not None:
        _server.stop()
        _server = None


class _Server:
    """The reader process and the socket to it."""

    def __init__(self):
        mine, other = socket.socketpair()
        self.control = Connection(mine.detach())
        search_path = json.dumps([folder for folder in sys.path if folder])
        one_thread = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        with other:
            self.process = subprocess.Popen(
                # -P: a module lying in the current folder is not taken for a library.
                [sys.executable, "-P", "-c", _START, search_path],
                stdin=other,
                stdout=subprocess.DEVNULL,
                env=os.environ | one_thread,  # forks of a process with threads can hang
            )

    def is_alive(self) -> bool:
        return self.process.poll() is None

    def read(self, request: dict, path: Path) -> tuple[list[dict], RawScan | None, int]:
        """Lines of the answer, the scan if there is one, and the status of the fork."""
        self.control.send_bytes(to_text(request))
        try:
            answer = recv_handle(self.control)
        except EOFError:
            message = f"{path}: the reader process ended; its error message is above"
            raise RuntimeError(message) from None
        with open(answer, "rb") as stream:
            lines, raw = _read_answer(stream)
        status, peak, seconds = from_text(self.control.recv_bytes())["used"]
        used = "%s: status %d, peak memory %d, %.2f s"
        logging.getLogger(__name__).debug(used, path, status, peak, seconds)
        return lines, raw, status

    def stop(self) -> None:
        self.control.close()
        self.process.kill()
        self.process.wait()


def _read_answer(stream):
    """Read lines up to the scan or the end; returns the scan or None."""
    lines, raw = [], None
    while line := stream.readline():
        if not line.endswith(b"\n"):  # the reader broke off
            break
        lines.append(from_text(line))
        if lines[-1]["outcome"] == "scan":
            raw = receive_scan(lines[-1], stream, lines[-2]["memory"])
            break
    return lines, raw


def _forget_server() -> None:
    """Drop the reader process in a fork, which must not use its parent's socket or wait for its
    lock.
    """
    global _lock, _server
    _lock = threading.Lock()
    if _server is not None:
        _server.control.close()
        _server.process.returncode = 0  # not our child: nothing to wait for
        _server = None


os.register_at_fork(after_in_child=_forget_server)
