"""Locks of a checkout: who gets it alone, who shares it, and a file system without locks."""

import errno
import os
import sys

import pytest
from places import ROOT

sys.path.append(str(ROOT / "workflow"))
from engine import running


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_nobody_is_alone_beside_a_process_at_work():
    os.close(running.alone(1)[0])
    running.mark()  # holds its lock until this process ends
    assert running.alone(0.25) == (None, True)


def test_an_exclusive_lock_keeps_others_out_until_it_is_shared():
    guard, has_locks = running.alone(1)
    assert has_locks
    assert running.alone(0.25)[0] is None
    other = os.open(running.FILE, os.O_RDWR)
    with pytest.raises(BlockingIOError):
        running.fcntl.flock(other, running.fcntl.LOCK_SH | running.fcntl.LOCK_NB)
    running.share(guard)
    running.fcntl.flock(other, running.fcntl.LOCK_SH | running.fcntl.LOCK_NB)
    assert running.alone(0.25)[0] is None


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP])
def test_a_file_system_without_locks_says_so(monkeypatch, number):
    def flock(handle, kind):
        raise OSError(number, "no locks")

    monkeypatch.setattr(running.fcntl, "flock", flock)
    guard, has_locks = running.alone(1)
    assert guard is not None
    assert not has_locks


def test_any_other_error_of_a_lock_is_raised(monkeypatch):
    def flock(handle, kind):
        raise OSError(errno.EIO, "a broken disk")

    monkeypatch.setattr(running.fcntl, "flock", flock)
    with pytest.raises(OSError, match="a broken disk"):
        running.alone(1)
