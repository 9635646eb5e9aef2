"""Files appear whole or not at all, and what a killed run left is swept."""

import os
import shutil
import subprocess
import sys

import pytest

from fractalcontact.core import atomic
from fractalcontact.core.atomic import UNFINISHED, atomic_write, sweep
from fractalcontact.core.errors import OutputError


def test_a_broken_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "x.txt"
    path.write_text("old")
    with pytest.raises(UnicodeEncodeError), atomic_write(path) as temporary:
        temporary.write_text("half \ud800", encoding="utf-8")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_content_reaches_the_disk_before_it_gets_its_name(tmp_path, monkeypatch):
    done = []
    monkeypatch.setattr(os, "fsync", lambda handle: done.append(os.fstat(handle).st_size))
    replace = os.replace
    monkeypatch.setattr(os, "replace", lambda *names: (done.append("named"), replace(*names)))
    with atomic_write(tmp_path / "x.txt") as temporary:
        temporary.write_text("12345")
    assert done == [5, "named"]


def test_a_folder_that_cannot_be_made_is_one_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with (
        pytest.raises(OutputError, match=r"file/x\.nc: cannot be written, File exists"),
        atomic_write(tmp_path / "file/x.nc"),
    ):
        pass


def test_a_full_disk_is_one_sentence_whatever_the_library_says(tmp_path, monkeypatch):
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: usage._replace(free=0))
    with (
        pytest.raises(OutputError, match=r"x\.nc: cannot be written, no space left"),
        atomic_write(tmp_path / "x.nc"),
    ):
        raise RuntimeError("NetCDF: HDF error")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.geteuid() != 0, reason="only root mounts a small disk")
def test_a_disk_that_is_really_full(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", disk], capture_output=True, text=True
    )
    if mounted.returncode:
        pytest.skip(f"no tmpfs can be mounted here: {mounted.stderr.strip()}")
    try:
        code = (
            "import sys, numpy as np, xarray as xr\n"
            "from fractalcontact.core.errors import OutputError\n"
            "from fractalcontact.core.netcdf import write\n"
            "data = np.random.default_rng(0).normal(size=10**6)\n"
            "try:\n"
            "    write(xr.Dataset({'a': ('x', data)}), sys.argv[1])\n"
            "except OutputError as error:\n"
            "    print(error)\n"
        )
        path = disk / "a.nc"
        done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)
        assert done.stdout == (
            f"{path}: cannot be written, no space left on its disk; make room there and run again\n"
        )
        assert list(disk.iterdir()) == []
    finally:
        subprocess.run(["umount", disk], check=True)


def test_what_a_killed_writer_left_is_swept_and_nothing_else(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a/x.nc").write_text("good")
    (tmp_path / "a/.hidden").write_text("somebody's")
    code = (
        "import os, sys\nfrom fractalcontact.core.atomic import atomic_write\n"
        "with atomic_write(sys.argv[1]) as path:\n    os._exit(9)\n"
    )
    subprocess.run([sys.executable, "-c", code, tmp_path / "a/y.nc"])
    (left,) = (tmp_path / "a").glob(f"{UNFINISHED}*")
    assert sweep(tmp_path) == [left]
    assert sorted(path.name for path in (tmp_path / "a").iterdir()) == [".hidden", "x.nc"]


def test_permissions_follow_the_mask_of_the_user(tmp_path):
    before = os.umask(0o027)
    try:
        with atomic_write(tmp_path / "x") as temporary:
            temporary.write_text("")
    finally:
        os.umask(before)
    assert (tmp_path / "x").stat().st_mode & 0o777 == 0o640
    assert atomic.UNFINISHED.startswith(".")
