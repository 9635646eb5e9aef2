"""Checksums of the results of a study, by which damaged files are detected and never read.

Every job stores, in the folder of its results, the SHA-256 of each file it made:
``results/NAME/checksums/STAGE/SPECIMEN.sha256`` for ``results/NAME/STAGE/SPECIMEN.nc``; files of
one folder that differ in their ending alone share one such record. Each line is as ``sha256sum -c``
takes it, in the folder ``results/NAME``.
"""

import contextlib
import hashlib
import json
import os
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from .atomic import atomic_write, reach_disk
from .errors import InputError

FOLDER, ENDING = "checksums", ".sha256"
#: Endings of the files that jobs make; other files in the folder of a study are not the program's.
RESULT_ENDINGS = (".csv", ".html", ".nc", ".npy", ".png", ".svg", ".txt", ".yaml", ".zip")
#: Endings of files that later jobs read.
_READ = (".nc", ".npy")
MANIFEST = "manifest.sha256"
#: Folder of a study to which damaged files are moved.
ASIDE = "damaged"
#: Cache of the checksums computed in a checkout.
KNOWN = Path(".snakemake/fractalcontact-digests.json")
#: Nanoseconds after a change within which a file may change again without its times showing it.
_SAME_TICK = 2_000_000_000


def sha256(path: Path | str) -> str:
    """SHA-256 of a file's content, in hexadecimal digits."""
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


class Digests:
    """SHA-256 of files, not computed again while a file's identity, size and times are the same.

    No program can set the time of the last change of status, so that moving, copying or unpacking
    an older file over another is noticed, as git notices it. The file ``cache`` stores the digests;
    if it is damaged or missing, it is made anew.
    """

    def __init__(self, cache: Path | str = KNOWN):
        self._cache, self._new = Path(cache), False
        self._known: dict[str, list] = {}
        with contextlib.suppress(OSError, UnicodeDecodeError):  # a cache may be missing or damaged
            checksum, _, text = self._cache.read_text(encoding="utf-8").partition("\n")
            if hashlib.sha256(text.encode()).hexdigest() == checksum:
                self._known = json.loads(text)

    def of(self, path: Path | str) -> str:
        """SHA-256 of a file; OSError if it cannot be read."""
        cached = self._known.get(str(path))
        identity = _identity(path)
        if cached and cached[1:] == identity:
            return cached[0]
        digest = sha256(path)
        still = _identity(path) == identity
        if still and time.time_ns() - identity[-1] > _SAME_TICK:
            self._known[str(path)] = [digest, *identity]
            self._new = True
        return digest

    def save(self) -> None:
        """Store the checksums computed; if they cannot be stored, they are computed again."""
        if self._new:
            text = json.dumps(self._known)
            checksum = hashlib.sha256(text.encode()).hexdigest()
            with contextlib.suppress(OSError), atomic_write(self._cache) as path:
                path.write_text(f"{checksum}\n{text}", encoding="utf-8")


def _identity(path):
    status = os.stat(path)
    return [status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns]


def record(results: Path | str, files: Iterable[Path | str]) -> None:
    """Store the checksums of the files made by a job, below the folder ``results`` of the study.

    Files that share a record are given in one call.
    """
    results = Path(results)
    records: dict[Path, list[Path]] = {}
    for file in map(Path, files):
        records.setdefault(record_of(results, file), []).append(file)
    for path, members in records.items():
        lines = [f"{sha256(f)}  {f.relative_to(results).as_posix()}\n" for f in sorted(members)]
        with atomic_write(path) as temporary:
            temporary.write_text("".join(lines), encoding="utf-8")
    folders = {file.parent for members in records.values() for file in members}
    reach_disk(folders | {path.parent for path in records})


def require_intact(results: Path | str, file: Path | str) -> None:
    """Refuse with an InputError a file without a checksum or unlike the one that its job made."""
    results, file = Path(results), Path(file)
    path = record_of(results, file)
    if not path.is_file():
        raise InputError(
            f"{file}: the record of its making is missing ({path}); 'make' sets it aside and "
            "makes it again"
        )
    if sha256(file) != _lines(path).get(file.relative_to(results).as_posix()):
        raise InputError(
            f"{file}: damaged or replaced after it was made (its checksum is not that in {path}); "
            "'make' sets it aside and makes it again"
        )


@dataclass(frozen=True)
class Checked:
    """Files of a study, compared with their checksums.

    Attributes
    ----------
    intact, damaged, missing : list of pathlib.Path
        Files with a checksum. Where the record is damaged, it and all its files are damaged.
    unrecorded : list of pathlib.Path
        Files without a checksum that later jobs would read.
    """

    intact: list[Path]
    damaged: list[Path]
    missing: list[Path]
    unrecorded: list[Path]


def check(results: Path | str, digest: Callable[[Path], str] = sha256) -> Checked:
    """Comparison of all files of a study with their checksums.

    ``digest`` gives the SHA-256 of a path: that of a :class:`Digests` saves time.
    """
    results = Path(results)
    checked = Checked([], [], [], [])
    for path in sorted((results / FOLDER).rglob(f"*{ENDING}")):
        lines = _lines(path)
        if not lines:
            checked.damaged.extend([path, *_recorded_in(results, path)])
        for name, recorded in lines.items():
            file = results / name
            if not file.is_file():
                checked.missing.append(file)
            # The checksum is computed in full before the file counts as damaged.
            elif recorded == digest(file) or recorded == sha256(file):
                checked.intact.append(file)
            else:
                checked.damaged.append(file)
    with_record = {*checked.intact, *checked.damaged}
    on_disk = (path for path in results.rglob("*") if path.suffix in _READ and path.is_file())
    checked.unrecorded.extend(
        path
        for path in sorted(on_disk)
        if path not in with_record and not {ASIDE, FOLDER} & set(path.relative_to(results).parts)
    )
    return checked


def set_aside(results: Path | str, file: Path | str) -> Path:
    """Move a damaged file, which may be its owner's work, to a folder that nothing reads.

    Returns its new path.
    """
    target = Path(results) / ASIDE / Path(file).relative_to(results)
    target.parent.mkdir(parents=True, exist_ok=True)
    os.replace(file, target)
    return target


def write_manifest(results: Path | str) -> None:
    """Write all checksums to one file next to the atlas, in the form of ``sha256sum -c``."""
    results = Path(results)
    if results.is_dir():
        with atomic_write(results / MANIFEST) as path:
            path.write_text("".join(lines_of(results)), encoding="utf-8")


def lines_of(results: Path | str) -> list[str]:
    """All lines of the records of a study for existing files, sorted."""
    results = Path(results)
    lines: list[str] = []
    for path in (results / FOLDER).rglob(f"*{ENDING}"):
        recorded = _lines(path).items()
        lines += [f"{digest}  {name}\n" for name, digest in recorded if (results / name).is_file()]
    return sorted(lines, key=lambda line: line[66:])


def record_of(results: Path | str, file: Path | str) -> Path:
    """File with the checksums of a result and of those that differ only in their ending."""
    results, file = Path(results), Path(file)
    name = file.relative_to(results)
    return results / FOLDER / name.with_name(name.stem + ENDING)


def _recorded_in(results, path):
    """Existing files whose checksums a record holds, by name."""
    folder = (results / path.relative_to(results / FOLDER)).parent
    stem = path.name.removesuffix(ENDING)
    files = (f for f in folder.glob("*") if f.stem == stem and f.suffix in RESULT_ENDINGS)
    return sorted(f for f in files if f.is_file())


def _lines(path):
    """Checksums by name in a record; empty if it is missing or damaged."""
    try:
        text = path.read_text(encoding="utf-8")
    except (FileNotFoundError, UnicodeDecodeError):
        return {}
    recorded = {}
    for line in text.splitlines(keepends=True):
        digest, _, name = line.partition("  ")
        whole = line.endswith("\n") and len(digest) == 64 and name.strip()
        if not whole or Path(name).is_absolute() or ".." in Path(name).parts:
            return {}
        recorded[name.rstrip("\n")] = digest
    return recorded
