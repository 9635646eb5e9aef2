"""Digest of a kernel: its instructions and everything they refer to."""

import hashlib
import sys
from collections.abc import Iterator
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np
from numba.core.dispatcher import Dispatcher
from numba.extending import _Intrinsic

_OWN = __name__.partition(".")[0]


def kernel_digest(kernel: Dispatcher) -> str:
    """Hexadecimal digest of everything that determines the machine code of a kernel.

    It is computed from Python's byte code and therefore ignores comments and file names; it is the
    same in every process and wherever the package lies. A TypeError is raised if the kernel uses an
    object of which only the address in memory is known.
    """
    total = hashlib.sha256()
    for part in _parts(kernel, set()):
        total.update(f"{part}\n".encode())
    return total.hexdigest()


def _parts(value: Any, seen: set[int]) -> Iterator[str]:
    """Text of each part that a value consists of."""
    if isinstance(value, Dispatcher):
        yield "kernel"
        yield from _parts(sorted(value.targetoptions.items()), seen)
        yield from _of_function(value.py_func, seen)
    elif isinstance(value, _Intrinsic):
        # The generated code of a kernel may use functions without a name, such as overloads of
        # operators.
        yield from _of_functions(sys.modules[value._defn.__module__], seen)
    elif isinstance(value, FunctionType):
        yield from _of_function(value, seen)
    elif isinstance(value, CodeType):
        yield from _of_code(value, seen)
    elif isinstance(value, tuple | list):
        yield f"{len(value)} of"
        for item in value:
            yield from _parts(item, seen)
    elif isinstance(value, set | frozenset):
        yield from _parts(sorted(value, key=repr), seen)
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    elif isinstance(value, ModuleType):
        yield value.__name__
    elif isinstance(value, type) or callable(value):
        yield f"{getattr(value, '__module__', '')} {getattr(value, '__qualname__', repr(value))}"
    else:
        yield _written(value)


def _written(value: Any) -> str:
    text = repr(value)
    if " at 0x" in text:
        raise TypeError(f"a kernel uses {text}, which has no value but an address")
    return text


def _of_function(function: FunctionType, seen: set[int]) -> Iterator[str]:
    if id(function) in seen:
        yield f"again {function.__qualname__}"
        return
    seen.add(id(function))
    yield from _of_code(function.__code__, seen)
    yield from _parts(function.__defaults__ or (), seen)
    yield from _parts(sorted((function.__kwdefaults__ or {}).items()), seen)
    for cell in function.__closure__ or ():
        yield from _parts(cell.cell_contents, seen)
    packages = {_OWN, function.__module__.partition(".")[0]}
    names = sorted(_names(function.__code__))
    for name in names:
        if name in function.__globals__:
            value = function.__globals__[name]
            yield name
            yield from _parts(value, seen)
            if isinstance(value, ModuleType) and value.__name__.partition(".")[0] in packages:
                for attribute in names:
                    if hasattr(value, attribute):
                        if isinstance(getattr(value, attribute), ModuleType):
                            raise TypeError(f"{function.__qualname__}: import {attribute} by name")
                        yield attribute
                        yield from _parts(getattr(value, attribute), seen)


def _of_functions(module: ModuleType, seen: set[int]) -> Iterator[str]:
    """Parts of every function and intrinsic of a module."""
    for name, value in sorted(vars(module).items()):
        definition = value._defn if isinstance(value, _Intrinsic) else value
        if isinstance(definition, FunctionType) and definition.__module__ == module.__name__:
            yield name
            yield from _of_function(definition, seen)


def _of_code(code: CodeType, seen: set[int]) -> Iterator[str]:
    yield f"{code.co_code.hex()} {code.co_varnames} {code.co_names} {code.co_freevars}"
    yield from _parts(code.co_consts, seen)


def _names(code: CodeType) -> set[str]:
    """Names that code looks up, those of inner functions included."""
    inner = (_names(const) for const in code.co_consts if isinstance(const, CodeType))
    return set(code.co_names).union(*inner)
