"""Source files that a module with kernels follows from, and their digest.

They decide which compiled kernels are out of date, file by file: a comment elsewhere compiles
nothing. What jobs make goes by rooms (`core.code_digest`). Import statements are found by a regular
expression, at the beginning of any line: to parse the package would take half a second in every
process that solves.
"""

import hashlib
import os
import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

#: `from MODULE import NAMES` or `import MODULES`, at the beginning of a line.
_STATEMENT = re.compile(
    rb"\n[ \t]*(?:"
    rb"from[ \t]+([.\w]+)[ \t]+import[ \t]*(\((?:[^)#]|#[^\n]*)*\)|[^\n#;]+)"
    rb"|import[ \t]+([^\n#;]+))"
)
_COMMENT = re.compile(rb"#[^\n]*")
#: Line of a table in an `__init__` that imports names when they are first asked for.
_LAZY = re.compile(rb'"(\w+)": "\.([\w.]+)"')
#: Call that imports every module of a package, see :func:`core.modules.modules_of`.
_ALL_OF = re.compile(rb"\bmodules_of\((\w+)\)")


def source_files(paths: Iterable[Path | str], *, package: Path | str) -> list[Path]:
    """Files of source code, and all that they import, near or far, from a package or beside them.

    Parameters
    ----------
    paths : iterable of path-like
    package : path-like
        Folder of the package.

    Returns
    -------
    list of pathlib.Path
        Absolute, sorted, each once. Imports inside functions count, and the ``__init__.py`` of
        every package on the way, and every module of a package given to `core.modules.modules_of`.
        Other modules whose names are put together at run time are not seen.
    """
    package_folder, tree = os.path.abspath(package), _Tree()
    queue = [os.path.abspath(path) for path in paths]
    seen: set[str] = set()
    while queue:
        path = queue.pop()
        if path not in seen:
            seen.add(path)
            queue += tree.passed_through(path)
            queue += _followed(path, package_folder, tree)
    return sorted(map(Path, seen))


def digest(
    paths: Iterable[Path | str],
    *,
    root: Path | str,
    versions: Mapping[str, str] | None = None,
) -> str:
    """Sixteen digits that change with the content or the name of any of these files.

    Parameters
    ----------
    paths : iterable of path-like
        In any order.
    root : path-like
        Folder they are in: names count from there, so that a moved checkout stays the same.
    versions : mapping of str to str, optional
        Versions that count too, by library.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If a file is not below ``root``.
    """
    top = os.path.join(os.path.abspath(root), "")
    named = {}
    for path in map(os.path.abspath, paths):
        if not path.startswith(top):
            raise ValueError(f"{path}: not below {top}; give a root that holds all files")
        named[path.removeprefix(top)] = path
    total = hashlib.sha256()
    for name in sorted(named):
        total.update(f"{name} {hashlib.sha256(_read(named[name])).hexdigest()}\n".encode())
    for name, version in sorted((versions or {}).items()):
        total.update(f"{name}=={version}\n".encode())
    return total.hexdigest()[:16]


class _Tree:
    """Which modules there are, as of now: every folder is looked into once."""

    def __init__(self) -> None:
        self._names: dict[str, set[str]] = {}

    def _has(self, folder, name):
        if folder not in self._names:
            self._names[folder] = set(os.listdir(folder)) if os.path.isdir(folder) else set()
        return name in self._names[folder]

    def is_package(self, folder: str) -> bool:
        return self._has(folder, "__init__.py")

    def module(self, folder: str, name: str) -> str | None:
        """The file of a module in a folder, or None."""
        if self._has(folder, name) and self.is_package(inner := f"{folder}/{name}"):
            return f"{inner}/__init__.py"
        return f"{folder}/{name}.py" if self._has(folder, f"{name}.py") else None

    def modules(self, folder: str) -> list[str]:
        """The files of all modules in a folder."""
        self._has(folder, "")
        names = (name.removesuffix(".py") for name in sorted(self._names[folder]))
        return [file for name in names if (file := self.module(folder, name)) is not None]

    def passed_through(self, path: str) -> list[str]:
        """The `__init__.py` of every package that a file is in."""
        found, folder = [], os.path.dirname(path)
        while self.is_package(folder):
            found.append(f"{folder}/__init__.py")
            folder = os.path.dirname(folder)
        return found


def _followed(path, package, tree):
    """The files that one file imports."""
    found = []
    content = _read(path)
    whole = {name.decode() for name in _ALL_OF.findall(content)}
    for module, names in _imports(content):
        inner = module.lstrip(".")
        level, parts = len(module) - len(inner), inner.split(".") if inner else []
        if level:
            folder = os.path.dirname(path)
            for _ in range(level - 1):
                folder = os.path.dirname(folder)
        elif parts[0] == os.path.basename(package):
            folder = os.path.dirname(package)
        elif _is_beside(path, parts[0], tree):
            folder = os.path.dirname(path)
        else:
            continue
        for part in parts:
            file = tree.module(folder, part)
            folder = f"{folder}/{part}"
            found.append(file)
        if not parts or file == f"{folder}/__init__.py":
            names = _names(_COMMENT.sub(b"", names).strip(b"() \n"))
            found += [tree.module(folder, name) or _lazily(folder, name, tree) for name in names]
            for name in whole.intersection(names):
                found += tree.modules(f"{folder}/{name}")
    return [file for file in found if file is not None]


def _lazily(folder, name, tree):
    """The module that a package takes a name from when it is first asked for, or None."""
    init = f"{folder}/__init__.py"
    home = tree.is_package(folder) and dict(_LAZY.findall(_read(init))).get(name.encode())
    if not home:
        return None
    *inner, module = home.decode().split(".")
    return tree.module("/".join([folder, *inner]), module)


def _is_beside(path, name, tree):
    """Whether a script imports this from its own folder, which modules of a package cannot."""
    folder = os.path.dirname(path)
    return not tree.is_package(folder) and tree.module(folder, name) is not None


# By content: a file may change while a process lives.
@cache
def _imports(content):
    """Pairs of a module, with its dots, and the names taken from it as they stand there."""
    found = []
    if b"\r" in content or b"\\\n" in content:
        content = content.replace(b"\r", b"").replace(b"\\\n", b" ")
    for module, names, modules in _STATEMENT.findall(b"\n" + content):
        if module:
            found.append((module.decode(), names))
        else:
            found += [(name, b"") for name in _names(modules)]
    return found


def _names(listed):
    """Names between commas, without what they are called here; none of a sentence."""
    words = [item.split() for item in listed.decode().split(",") if item.strip()]
    is_list = all(len(word) == 1 or word[1:2] == ["as"] for word in words)
    return [word[0] for word in words] if is_list else []


def _read(path):
    with open(path, "rb") as file:
        return file.read()
