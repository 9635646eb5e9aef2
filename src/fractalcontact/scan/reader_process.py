"""Process that reads scan files, separate from the one that uses them.

It waits for requests on a socket and forks once for each file. The fork limits itself, reads and
ends; whatever a file does to it, this process and the one that asked stay as they were.

Linux enforces all limits. macOS does not enforce the one on memory.
"""

import contextlib
import gc
import os
import resource
import signal
import sys
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from multiprocessing.connection import Connection
from multiprocessing.reduction import send_handle
from pathlib import Path

from ..core.errors import InputError
from ..core.labels import printable
from .files import inflated_size, regular_file
from .format import Format
from .options import ScanOptions
from .raw import IncompleteSidecar, RawScan
from .transfer import from_text, send_scan, to_text

#: Bytes beyond what the process has at the start, for a file of any size.
BASE_MEMORY = 1024**3
#: Seconds of processor time for a file of any size.
BASE_SECONDS = 8
#: Seconds by the clock over those of processor that the reader may take, on a machine shared with
#: others or with a slow disc.
PATIENCE = 4
_MAX_FILES = 64
#: Longest message in characters; sentences of this program are far shorter.
_LONGEST_MESSAGE = 1600
_LONGEST_DRAFT = 6000


@dataclass(frozen=True)
class Limits:
    """Limits of reading one file: bytes, seconds of processor time, seconds by the clock."""

    memory: int
    processor_seconds: int
    seconds: int


def limits_for(size: int, formats: Sequence[Format]) -> Limits:
    """Limits for a file of ``size`` bytes, inflated; the most generous format counts."""
    memory_per_byte = max((form.memory_per_byte for form in formats), default=0)
    seconds_per_megabyte = max((form.seconds_per_megabyte for form in formats), default=0)
    seconds = BASE_SECONDS + seconds_per_megabyte * size // 10**6
    return Limits(BASE_MEMORY + memory_per_byte * size, seconds, PATIENCE * seconds)


def serve() -> None:
    """Read files for the process at the other end of standard input until it closes."""
    control = Connection(os.dup(0))
    _close_standard_streams(0)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which then hangs up
    while True:
        try:
            request = from_text(control.recv_bytes())
        except EOFError:
            return
        _import_libraries(Path(request["path"]).suffix.lower())
        readable, writable = os.pipe()
        pid = os.fork()
        if pid == 0:
            control.close()
            os.close(readable)
            _read_and_exit(request, writable)
        os.close(writable)
        send_handle(control, readable, pid)
        os.close(readable)
        _, status, usage = os.wait4(pid, 0)
        # Memory in kB, on macOS in bytes.
        used = status, usage.ru_maxrss, usage.ru_utime + usage.ru_stime
        control.send_bytes(to_text({"used": used}))


def _import_libraries(extension: str) -> None:
    """Import the libraries of a format once, before the forks."""
    from .formats import likely_formats

    for form in likely_formats(extension):
        for name in form.libraries:
            with contextlib.suppress(ImportError):  # the fork reports the error
                import_module(name)
    gc.freeze()  # objects that forks share are not touched, so not copied


def _read_and_exit(request: dict, writable: int) -> None:
    """Read one file in this fork, send the outcome and end without any clean-up of the parent's."""
    code = 1
    try:
        _close_standard_streams(0, 1, 2)  # what a library prints is not meant for the user
        sys.dont_write_bytecode = True
        with open(writable, "wb") as stream:
            _read(request, stream)
        code = 0
    except BrokenPipeError:  # nobody waits any more
        code = 0
    finally:
        os._exit(code)


def _read(request: dict, stream) -> None:
    from .formats import likely_formats, read_raw

    def allow(size: int) -> None:
        limits = limits_for(size, formats)
        stream.write(to_text({"outcome": "limits", **vars(limits)}))
        stream.flush()
        _confine(limits, already)

    path = Path(request["path"])
    formats = likely_formats(path.suffix.lower())
    already = _address_space()
    try:
        os.chdir(request["folder"])
        allow(regular_file(path).st_size)
        allow(inflated_size(path))
        raw = read_raw(path, ScanOptions(**request["options"]))
        _require_table(raw, path)
        send_scan(raw, stream)
    except BrokenPipeError:
        raise
    except MemoryError:
        stream.write(to_text({"outcome": "memory"}))
    except IncompleteSidecar as error:
        draft = "\n".join(f"    {line}" for line in error.draft.split("\n"))
        report = {"outcome": "incomplete", "message": _readable(error.message)}
        stream.write(to_text(report | {"draft": _readable(draft, _LONGEST_DRAFT)}))
    except InputError as error:
        # A reader may report a lack of memory as a damaged file.
        outcome = "memory" if _is_from_memory(error) else "refused"
        stream.write(to_text({"outcome": outcome, "message": _readable(str(error))}))
    except OSError as error:  # the disc or the network, or what a library asked of them
        message = f"{path}: cannot be read ({error}); copy the file anew"
        stream.write(to_text({"outcome": "refused", "message": _readable(message)}))
    except Exception as error:
        name, trace = type(error).__name__, traceback.format_exc()
        report = {"outcome": "bug", "message": f"{name}: {error}", "traceback": trace}
        stream.write(to_text(report))


def _readable(message: str, longest: int = _LONGEST_MESSAGE) -> str:
    """A message without the pages, or the terminal's commands, that a library quotes of a file."""
    if len(message) > longest:
        half = longest // 2
        message = f"{message[:half]} ... {message[-half:]}"
    return "\n".join(map(printable, message.split("\n")))


def _require_table(raw: RawScan, path: Path) -> None:
    """A damaged header can make a library return any shape."""
    shape = raw.values.shape
    if len(shape) != 2 or 0 in shape or (raw.layout != "matrix" and shape[1] != 3):
        raise InputError(
            f"{path}: expected rows and columns of heights or points x, y, z, found an array of "
            f"shape {shape}; damaged? Export it again"
        )


def _is_from_memory(error: BaseException | None) -> bool:
    while error is not None and not isinstance(error, MemoryError):
        error = error.__cause__ or error.__context__
    return error is not None


def _confine(limits: Limits, already: int) -> None:
    """Bound memory, time and files of this process; the system ends it beyond these bounds."""
    _lower(resource.RLIMIT_AS, already + limits.memory)
    _lower(resource.RLIMIT_CPU, limits.processor_seconds)
    _lower(resource.RLIMIT_FSIZE, 0)
    _lower(resource.RLIMIT_CORE, 0)
    _lower(resource.RLIMIT_NOFILE, _MAX_FILES)
    for number in (signal.SIGXCPU, signal.SIGALRM):
        signal.signal(number, signal.SIG_DFL)
    signal.alarm(limits.seconds)


def _lower(limit: int, value: int) -> None:
    """Set a soft limit, never above the hard one that the user or the cluster has set."""
    _, hard = resource.getrlimit(limit)
    if hard != resource.RLIM_INFINITY:
        value = min(value, hard)
    resource.setrlimit(limit, (value, hard))


def _address_space() -> int:
    """Bytes of address space this process has; 0 where the system does not state it."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[0])
    except FileNotFoundError:  # macOS, which does not enforce RLIMIT_AS either
        return 0
    return pages * resource.getpagesize()


def _close_standard_streams(*numbers: int) -> None:
    """Replace standard input, output or error by the null device."""
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in numbers:
        os.dup2(nothing, number)
    if nothing > 2:
        os.close(nothing)
