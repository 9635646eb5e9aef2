"""Digest of the code of a job: a changed digest makes its results again.

Code counts by rooms, the folders of a package: a job's own modules count file by file, and every
room that they import from counts whole, with all rooms below it. So a change in a room makes the
jobs of that room and of those above it run again, and a change in tests or documents none.
"""

import hashlib
import os
import re
import sys
from collections.abc import Iterable, Iterator
from functools import cache, cached_property
from pathlib import Path

#: Module of an import at the beginning of any line. A line of prose that matches does no harm.
_IMPORTED = re.compile(rb"^[ \t]*(?:from|import)[ \t]+([.\w]+)", re.MULTILINE)
#: Distributions whose name differs from that of their module.
_DISTRIBUTIONS = {"mpl_toolkits": "matplotlib", "yaml": "PyYAML"}


class Code:
    """Python packages in a folder, of which every file is read once.

    Names of files are relative to ``root``, so that a moved checkout keeps its digests. Scripts
    import modules of the folder ``beside`` too, beside those of their own folder.
    """

    def __init__(self, folder: Path | str, root: Path | str, beside: Path | str = ""):
        self.folder, self.root = os.path.abspath(folder), os.path.abspath(root)
        self.beside = os.path.abspath(beside) if beside else ""
        self._read = cache(_read)
        # Some dozen digests of a run follow the same files.
        self._imports = cache(lambda file, whole: [*self._followed(file, whole)])

    def digest(self, *names: Path | str) -> str:
        """Sixteen digits that change with any file behind these names and the libraries they use.

        A name is the file of a script or, below the folder of the packages, a module
        ("package/room/module.py") or a whole room ("package/room").
        """
        files = sorted(self.files_behind(*names))
        lines = [f"{os.path.relpath(file, self.root)} {self._read(file)[0]}" for file in files]
        lines += [f"{name}=={version}" for name, version in self.versions(files).items()]
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]

    def files_behind(self, *names: Path | str) -> set[str]:
        """Paths of all files that count for the names of :meth:`digest`."""
        found: set[str] = set()
        seen: set[str] = set()
        queue = [os.path.join(self.folder, name) for name in names]
        while queue:
            place = queue.pop()
            if place not in seen:
                seen.add(place)
                whole = place in self._rooms
                files = self._rooms[place] if whole else [place, *self._inits(place)]
                found.update(files)
                for file in files:
                    queue += self._imports(file, whole)
        return found

    def _inits(self, file: str) -> list[str]:
        """Files that run before a module: ``__init__.py`` of its folder and of its room."""
        folders = {os.path.dirname(file), self._room_of(file)} - {None}
        inits = [f"{folder}/__init__.py" for folder in folders]
        return [init for init in inits if self._room_of(init) and os.path.isfile(init)]

    def versions(self, files: Iterable[str]) -> dict[str, str]:
        """Versions of the installed libraries that files import, by name; with numba llvmlite's."""
        named = {module.partition(".")[0] for file in files for module in self._read(file)[1]}
        named |= {"llvmlite"} if "numba" in named else set()
        own = {os.path.basename(room) for room in self._rooms} | sys.stdlib_module_names | {""}
        versions = {name: _version(name) for name in sorted(named - own)}
        return {name: version for name, version in versions.items() if version}

    @cached_property
    def _rooms(self) -> dict[str, list[str]]:
        """Files of each room, of any kind: templates and tables too.

        The files that lie directly in a package are a room of their own.
        """
        rooms: dict[str, list[str]] = {}
        for package in _folders(self.folder):
            rooms[package] = [entry.path for entry in os.scandir(package) if entry.is_file()]
            for room in _folders(package):
                walked = os.walk(room)
                rooms[room] = [
                    os.path.join(where, name)
                    for where, _, names in walked
                    if "__pycache__" not in where
                    for name in names
                ]
        return rooms

    def _followed(self, file: str, whole: bool) -> Iterator[str]:
        """Imports of a file: rooms, and files of its own room unless that counts whole."""
        home = os.path.dirname(file)
        room = self._room_of(home)
        for module in self._read(file)[1]:
            inner = module.lstrip(".")
            above = len(module) - len(inner)
            base = home.rsplit("/", above - 1)[0] if above else self.folder
            target = f"{base}/{inner.replace('.', '/')}".rstrip("/")
            its = self._room_of(target)
            if its is None:
                near = [home, *([self.beside] if self.beside and not above else [])]
                candidates = [f"{place}/{inner.replace('.', '/')}.py" for place in near]
                yield from [path for path in candidates if room is None and os.path.isfile(path)]
                continue
            if its == room and whole:
                continue
            package = f"{self.folder}/{target[len(self.folder) + 1 :].partition('/')[0]}"
            if target == package:  # only the running program knows which of its modules it imports
                yield from (path for path in self._rooms if path.startswith(package))
            elif room in (None, its) and os.path.isfile(f"{target}.py"):
                yield from (f"{target}.py", package)
            else:
                yield from (its, package)

    def _room_of(self, path: str) -> str | None:
        """Room of a path, or its package; None outside all packages."""
        if not path.startswith(f"{self.folder}/"):
            return None
        package, room, *_ = [*path[len(self.folder) + 1 :].split("/"), ""]
        places = (f"{self.folder}/{package}/{room}", f"{self.folder}/{package}")
        return next((place for place in places if place in self._rooms), None)


def _folders(folder):
    names = (entry for entry in os.scandir(folder) if entry.is_dir())
    return [entry.path for entry in names if not entry.name.startswith((".", "__"))]


def _read(file):
    """Checksum of a file, and the modules that it imports."""
    with open(file, "rb") as stream:
        content = stream.read()
    imported = _IMPORTED.findall(content) if file.endswith(".py") else []
    return hashlib.sha256(content).hexdigest(), {module.decode() for module in imported}


@cache
def _version(name):
    from importlib import metadata  # takes longer to import than all the rest

    try:
        return metadata.version(_DISTRIBUTIONS.get(name, name))
    except (metadata.PackageNotFoundError, ValueError):
        return ""
