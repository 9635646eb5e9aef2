"""Calls in a child process of foreign code, which may crash, never end or print without end."""

import faulthandler
import multiprocessing
import os
import signal
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


class ChildFailed(RuntimeError):
    """Failure of a call in a child process: an error, a crash or a timeout, as the text says."""


def in_child(call: Callable[[], T], *, seconds: float) -> T:
    """Result of a call in a fork of this process, copied from there.

    It runs on one thread, since the threads of the parent do not exist there. Its output is
    dropped. ChildFailed if it fails or takes longer than ``seconds``.
    """
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_answer, args=(call, seconds, sender))
    child.start()
    # The child now has the only open end, so that the pipe closes however the child ends.
    sender.close()
    try:
        value, said = receiver.recv()
    except EOFError:
        child.join()
        raise ChildFailed(_ending(child.exitcode, seconds)) from None
    finally:
        receiver.close()
        child.kill()
        child.join()
    if said:
        raise ChildFailed(said)
    return value


def _answer(call, seconds, sender):
    os.environ["OMP_NUM_THREADS"] = "1"
    faulthandler.disable()
    with open(os.devnull, "wb") as nothing:
        for stream in (1, 2):
            os.dup2(nothing.fileno(), stream)
    # An unhandled alarm ends the process, even in a loop of C and without a parent.
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        value, said = call(), ""
    except Exception as error:
        value, said = None, f"{type(error).__name__}: {error}"
    sender.send((value, said))


def _ending(exitcode, seconds):
    if exitcode == -signal.SIGALRM:
        return f"took longer than {seconds:g} s"
    if exitcode < 0:
        return f"crashed: {signal.Signals(-exitcode).name}"
    return f"crashed: exit code {exitcode}"
