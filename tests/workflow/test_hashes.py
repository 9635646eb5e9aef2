"""Inputs of many outputs are hashed once, and again when they change."""

import asyncio
import os
import sys
from types import SimpleNamespace

import pytest
from places import ROOT

from fractalcontact.core import checksums
from fractalcontact.core.checksums import sha256

sys.path.append(str(ROOT / "workflow/scripts"))
import _hashes


@pytest.fixture
def hashing(monkeypatch, tmp_path):
    """Checksums as Snakemake asks for them, and the files that were read for them."""
    times = []

    def read(path):
        times.append(path)
        return sha256(path)

    async def absent(file, *of):
        raise FileNotFoundError(file.file)

    monkeypatch.setattr(checksums, "sha256", read)
    monkeypatch.setattr(checksums, "_SAME_TICK", 0)
    monkeypatch.setattr(_hashes._IOFile, "checksum", absent)
    _hashes.hash_once(checksums.Digests(tmp_path / "digests.json"))
    return SimpleNamespace(of=_hashes._IOFile.checksum, times=times)


def file_at(path):
    """Checksum that Snakemake has of a file."""

    async def is_there(threshold):
        return path.exists() and path.stat().st_size <= threshold

    return SimpleNamespace(file=str(path), is_storage=False, is_checksum_eligible=is_there)


def test_a_file_is_hashed_once_and_again_when_another_takes_its_place_and_its_time(
    hashing, tmp_path
):
    path, other = tmp_path / "a.nc", tmp_path / "b.nc"
    path.write_bytes(b"one")
    file = file_at(path)
    first = {asyncio.run(hashing.of(file, 100)) for _ in range(120)}
    assert first == {f"sha256:{sha256(path)}"}
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
        asyncio.run(hashing.of(file_at(tmp_path / "none.nc"), 100))
