"""Modules found by listing the folder of their package; a new file adds a module."""

from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType


def modules_of(package: ModuleType) -> dict[str, ModuleType]:
    """Modules of a package by their names, sorted, all imported.

    The package is imported by the calling module with a statement, ``from . import NAME``, and
    given by that name; or it is ``sys.modules[__package__]``, the package of the calling module.
    """
    names = sorted(module.name for module in iter_modules(package.__path__))
    return {name: import_module(f"{package.__name__}.{name}") for name in names}
