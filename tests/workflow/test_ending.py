"""A run that is told to end while its own thread holds the lock of Snakemake's answer."""

import os
import signal
import subprocess
import sys
import threading

import pytest
from places import ROOT

sys.path.append(str(ROOT / "workflow"))
from engine.ending import TOLD, answer_in_thread

HELD = """
import os, signal, threading
lock, told = threading.Lock(), threading.Event()
def answer(*_):
    with lock:
        told.set()
signal.signal(signal.SIGTERM, answer)
{answered}
with lock:
    os.kill(os.getpid(), signal.SIGTERM)
told.wait()
print("ended")
"""
IN_THREAD = "from engine.ending import answer_in_thread; answer_in_thread()"


def begun(answered):
    return subprocess.Popen(
        [sys.executable, "-c", HELD.format(answered=answered)],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT / "workflow")},
    )


def test_a_signal_is_answered_though_the_main_thread_holds_the_lock():
    said, _ = begun(IN_THREAD).communicate(timeout=120)
    assert said == "ended\n"


def test_without_the_thread_it_waits_for_itself():
    process = begun("")
    with pytest.raises(subprocess.TimeoutExpired):
        process.communicate(timeout=3)
    process.kill()
    process.communicate()


def test_a_signal_that_nobody_answers_keeps_its_default():
    before = signal.signal(signal.SIGUSR1, signal.SIG_DFL)
    try:
        answer_in_thread(signal.SIGUSR1)
        assert signal.getsignal(signal.SIGUSR1) == signal.SIG_DFL
    finally:
        signal.signal(signal.SIGUSR1, before)


def test_the_answer_is_given_the_number_of_the_signal():
    told, done = [], threading.Event()

    def answer(number, frame):
        told.append(number)
        done.set()

    before = signal.signal(signal.SIGUSR1, answer)
    try:
        answer_in_thread(signal.SIGUSR1)
        os.kill(os.getpid(), signal.SIGUSR1)
        assert done.wait(60)
        assert told == [signal.SIGUSR1]
        assert TOLD.is_set()
    finally:
        TOLD.clear()
        signal.signal(signal.SIGUSR1, before)
