"""Calls in a child process: what they return, and every way in which they may end."""

import os
import signal
from itertools import repeat

import numpy as np
import pytest

from fractalcontact.core.child_process import ChildFailed, in_child


def test_what_a_call_returns_is_copied():
    field = np.arange(300_000.0)
    np.testing.assert_array_equal(in_child(lambda: 2 * field, seconds=10), 2 * field)


def test_a_child_runs_on_one_thread(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    assert in_child(lambda: os.environ["OMP_NUM_THREADS"], seconds=10) == "1"
    assert os.environ["OMP_NUM_THREADS"] == "7"


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: 1 / 0, "ZeroDivisionError: division by zero"),
        (lambda: os.kill(os.getpid(), signal.SIGSEGV), "crashed: SIGSEGV"),
        (os.abort, "crashed: SIGABRT"),
        (lambda: os._exit(3), "crashed: exit code 3"),
        # A loop of C, which no exception of Python ends.
        (lambda: sum(repeat(0)), "took longer than 0.2 s"),
    ],
    ids=["error", "segmentation fault", "abort", "exit", "endless loop"],
)
def test_a_call_that_ends_badly_says_how(call, words):
    with pytest.raises(ChildFailed, match=words):
        in_child(call, seconds=0.2)


def test_a_flood_of_words_is_dropped(capfd):
    in_child(lambda: os.write(1, b"word\n" * 10_000) + os.write(2, b"word\n"), seconds=10)
    assert capfd.readouterr() == ("", "")
