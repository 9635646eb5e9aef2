"""Inputs of many outputs are hashed once, and again when they change."""

import asyncio
import hashlib
import os
import sys
from types import SimpleNamespace

import pytest
from places import ROOT

sys.path.append(str(ROOT / "workflow/scripts"))
import _hashes


@pytest.fixture
def hashing(monkeypatch):
    """Snakemake's own file, which counts how often it is read."""
    times = []

    async def checksum(file, threshold=None):
        times.append(file.file)
        with open(file.file, "rb") as opened:
            return "sha256:" + hashlib.file_digest(opened, "sha256").hexdigest()

    monkeypatch.setattr(_hashes._IOFile, "checksum", checksum)
    _hashes.hash_once()
    return SimpleNamespace(of=_hashes._IOFile.checksum, times=times)


def test_a_file_is_hashed_once_and_again_when_another_takes_its_place_and_its_time(
    hashing, tmp_path
):
    path, other = tmp_path / "a.nc", tmp_path / "b.nc"
    path.write_bytes(b"one")
    file = SimpleNamespace(file=str(path))
    first = {asyncio.run(hashing.of(file, 100)) for _ in range(120)}
    assert len(hashing.times) == 1
    other.write_bytes(b"two")
    os.utime(other, ns=2 * (path.stat().st_mtime_ns,))
    os.replace(other, path)
    assert asyncio.run(hashing.of(file, 100)) not in first
    os.utime(path)
    asyncio.run(hashing.of(file, 100))
    assert len(hashing.times) == 3


def test_of_a_file_that_is_not_there_snakemake_says_what_it_says(hashing, tmp_path):
    with pytest.raises(FileNotFoundError):
        asyncio.run(hashing.of(SimpleNamespace(file=str(tmp_path / "none.nc")), 100))
