"""Cache on disk of compiled kernels, under a digest of everything they are compiled from.

numba's own cache knows a kernel by its file alone. If a kernel that it calls, or a constant that it
uses, changes in another module, numba loads the outdated machine code: wrong numbers, or a crash.
Here the file of a kernel is named after a digest of its instructions and of those of every kernel
it calls, directly or indirectly, of the constants they use, the options and the versions of the
compilers. The digest is computed from the running process, not from source files: an edit while it
runs has no effect, and an edit that changes no kernel compiles nothing.

Each kernel gets its own cache in place of numba's. Setting ``numba.config.CACHE_DIR`` would be
shorter, but applies to the kernels of other packages too, and numba would unpickle any file in that
folder. Here damaged files count as missing, and so do those that another user may have written.

Kernels are stored beside the package, in ``__pycache__/kernels``. Where the installation is
read-only they go to ``$XDG_CACHE_HOME/roughcontact`` (``~/.cache/roughcontact``), and failing that
to ``roughcontact-UID`` in the temporary folder; NUMBA_CACHE_DIR, if set, comes first.
`cache_folder` returns the folder in use.
"""

import contextlib
import hashlib
import logging
import os
import pickle
import stat
import sys
import tempfile
import uuid
import warnings
from collections.abc import Callable, Iterator
from functools import cache, cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import llvmlite
import numba
import numpy as np
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.registry import cpu_target
from numba.core.serialize import dumps

from .kernel_digest import kernel_digest

PACKAGE = Path(__file__).absolute().parent
#: Kernels stored with the package. Whoever can write there can change its code anyway.
PACKAGE_FOLDER = PACKAGE / "__pycache__" / "kernels"
LOG = logging.getLogger("roughcontact")
#: Most files kept of one kernel, over versions and types: switching between branches of the code
#: then compiles nothing.
MAX_FILES = 12
#: Size in bytes of the SHA-256 with which each file begins.
_CHECKSUM = hashlib.sha256().digest_size

#: Versions of the compilers, and options of debugging, which also change the machine code.
_VERSIONS = (
    f"{sys.implementation.cache_tag}{sys.abiflags}",
    *(library.__version__ for library in (numba, llvmlite, np)),
    *(str(getattr(numba.config, name)) for name in ("BOUNDSCHECK", "DEBUGINFO_DEFAULT", "OPT")),
)


def njit(function: Callable | None = None, /, *, cache: bool = False, **options: Any) -> Any:
    """``numba.njit`` for the modules of this package, with a cache that follows every change.

    Parameters
    ----------
    function : callable, optional
        The kernel. It is compiled for the types it is called with; no signature can be given.
    cache : bool, optional
        Whether compiled code is kept on disk.
    **options
        Options of ``numba.njit``.
    """
    if function is None:
        return lambda function: njit(function, cache=cache, **options)
    kernel: Any = numba.njit(function, **options)
    # With NUMBA_DISABLE_JIT numba returns the function as it is.
    if cache and kernel is not function:
        kernel._cache = KernelCache(kernel)
        _CACHED.append(kernel)
    return kernel


#: Kernels with a cache on disk.
_CACHED: list[Any] = []


def load_cached() -> int:
    """Load the compiled kernels of all imported modules from disk; returns their number.

    A process calls this before it forks, since each fork would otherwise load them again.
    """
    loaded = 0
    for kernel in _CACHED:
        compiled = set(kernel.signatures)
        for signature in kernel._cache.signatures():
            if signature not in compiled:
                kernel.compile(signature)
                compiled.add(signature)
                loaded += 1
    return loaded


def cache_folder() -> Path | None:
    """Folder to which compiled kernels are written; None if no folder is safe."""
    return _folders()[0]


class KernelCache(FunctionCache):
    """Compiled forms of one kernel: a checksummed file for each signature."""

    _warned = False
    _announced = False

    def __init__(self, kernel: Any):
        function = kernel.py_func
        qualified = function.__qualname__.replace("<", "").replace(">", "")
        self._stem = f"{function.__module__}.{qualified}"
        self._kernel = kernel
        self._py_func = function
        self._impl = _Serialised(function)
        self._cache_path, self._paths = _folders()
        self.enable()

    def flush(self) -> None:
        """Discard the compiled code of this kernel."""
        if self._cache_path is not None:
            for path in self._cache_path.glob(f"{self._stem}-*"):
                path.unlink(missing_ok=True)

    def signatures(self) -> Iterator[tuple]:
        """Signatures for which this kernel is on disk, compiled for this processor."""
        codegen = cpu_target.target_context.codegen()
        names = {path.name: path for path in self._files(f"{self._digest[:16]}-*.nbc")}
        for name, path in sorted(names.items()):
            content = _intact(path)
            if content is not None:
                (_, signature, *_), _ = saved = pickle.loads(content)
                if saved[0] == self._key(signature, codegen) and self._file_name(saved[0]) == name:
                    yield signature

    def _files(self, pattern):
        return (path for folder in self._paths for path in folder.glob(f"{self._stem}-{pattern}"))

    def _load_overload(self, sig, target_context):
        if not self._enabled:
            return None
        key = self._key(sig, target_context.codegen())
        name = self._file_name(key)
        for path in self._paths:
            content = _intact(path / name)
            if content is not None:
                saved, compiled = pickle.loads(content)
                # The file's name holds only a digest of the types' names.
                if saved == key:
                    return self._impl.rebuild(target_context, compiled)
        self._announce()
        return None

    def _announce(self):
        """Report that kernels are being compiled, which takes about a minute.

        Reported once per processor and set of versions, by the first process. One kernel that is
        missing for other types, or damaged, is not reported.
        """
        if not KernelCache._announced and not any(self._files(f"{self._digest[:16]}-*.nbc")):
            KernelCache._announced = True
            if self._is_first():
                text = (
                    "compiling kernels for this processor, once: about a minute of a free core (%s)"
                )
                LOG.warning(text, self._cache_path or "not kept")
        LOG.info("compiling %s", self._stem)

    def _is_first(self):
        """True if the newest kernel on disk is of another processor or other versions."""
        files = [path for folder in self._paths for path in folder.glob("*.nbc")]
        content = None
        with contextlib.suppress(FileNotFoundError):  # removed by another process meanwhile
            content = _intact(max(files, key=os.path.getmtime)) if files else None
        if content is None:
            return True
        (_, _, processor, _, *versions), _ = pickle.loads(content)
        mine = cpu_target.target_context.codegen().magic_tuple()
        return (processor, *versions) != (mine, *_VERSIONS)

    def _save_overload(self, sig, data):
        if not self._enabled or not self._impl.check_cachable(data):
            return
        if self._cache_path is None:
            places = " nor ".join(map(str, _candidate_folders()))
            self._warn(f"neither {places} is a folder that this user alone can write to")
            return
        key = self._key(sig, data.codegen)
        content = dumps((key, self._impl.reduce(data)))
        try:
            _write(self._cache_path / self._file_name(key), content)
            self._remove_old()
        except OSError as error:
            self._warn(f"{self._cache_path}: {error.strerror or error}")

    def _key(self, sig, codegen):
        """Key of a compiled kernel, processor included."""
        return self._stem, sig, codegen.magic_tuple(), self._digest, *_VERSIONS

    @cached_property
    def _digest(self):
        """Digest of the kernel, computed at its first call: it may use names defined below it."""
        return kernel_digest(self._kernel)

    def _remove_old(self):
        """Remove all but the newest files of this kernel."""
        with contextlib.suppress(FileNotFoundError):  # removed by another process meanwhile
            files = list(self._cache_path.glob(f"{self._stem}-*.nbc"))
            files.sort(key=lambda path: path.stat().st_mtime, reverse=True)
            for path in files[MAX_FILES:]:
                path.unlink()

    def _file_name(self, key):
        types = hashlib.sha256(repr(key).encode()).hexdigest()
        return f"{self._stem}-{self._digest[:16]}-{types[:16]}.nbc"

    @staticmethod
    def _warn(why):
        if not KernelCache._warned:
            KernelCache._warned = True
            warnings.warn(
                f"compiled kernels cannot be kept ({why}), so every process compiles them again; "
                "set NUMBA_CACHE_DIR to a folder of your own that has room",
                stacklevel=2,
            )


class _Serialised(CompileResultCacheImpl):
    """numba's serialisation of a compiled kernel, without its choice of a folder."""

    def __init__(self, function):
        code = function.__code__
        # numba names the file and line in its warning that a kernel cannot be cached.
        self._lineno = code.co_firstlineno
        self._locator = SimpleNamespace(_py_file=code.co_filename)


@cache
def _folders():
    """Folder for writing kernels, or None, and folders for reading them."""
    writable = next(filter(_is_safe, _candidate_folders()), None)
    wanted = next(_candidate_folders())
    if numba.config.CACHE_DIR and writable not in (wanted, None):
        warnings.warn(
            f"{wanted}: not a private folder of this user (mode 700), so compiled kernels "
            f"go to {writable}; set NUMBA_CACHE_DIR to another one, or remove this",
            stacklevel=2,
        )
    # Users who cannot write to the installation still read its kernels.
    readable = (writable,) if numba.config.CACHE_DIR else (writable, PACKAGE_FOLDER)
    return writable, [folder for folder in dict.fromkeys(readable) if folder is not None]


def _candidate_folders():
    if numba.config.CACHE_DIR:
        yield Path(numba.config.CACHE_DIR).absolute() / "roughcontact-kernels"
    yield PACKAGE_FOLDER
    users = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
    if users.is_absolute():
        yield users / "roughcontact"
    with contextlib.suppress(FileNotFoundError):  # the machine has no temporary folder
        yield Path(tempfile.gettempdir()) / f"roughcontact-{os.geteuid()}"


def _is_safe(folder):
    """True if kernels can be written to a folder and no other user can write there."""
    try:
        os.makedirs(folder, mode=0o777 if folder == PACKAGE_FOLDER else 0o700, exist_ok=True)
    except OSError:
        return False
    if not os.access(folder, os.W_OK | os.X_OK):
        return False
    status = os.lstat(folder)
    private = not status.st_mode & (stat.S_IRWXG | stat.S_IRWXO)
    owned = stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid()
    return folder == PACKAGE_FOLDER or (owned and private)


def _intact(path):
    """Content of a file whose checksum holds; None if it is missing or damaged."""
    try:
        content = path.read_bytes()
    except OSError:  # an unreadable file is compiled again
        return None
    checksum, content = content[:_CHECKSUM], content[_CHECKSUM:]
    return content if hashlib.sha256(content).digest() == checksum else None


def _write(path, content):
    """Write a file atomically, with its checksum."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.{uuid.uuid4().hex}")
    try:
        with open(temporary, "xb") as file:
            file.write(hashlib.sha256(content).digest() + content)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
