"""Names of a room, imported when they are first asked for.

To read the workflow, or one scan file, neither xarray, numba nor matplotlib may be imported.
"""

import sys
from collections.abc import Callable, Collection, Mapping
from importlib import import_module
from typing import Any


def exports(
    package: str, homes: Mapping[str, str], rooms: Collection[str] = ()
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """What an ``__init__`` needs to import its names when they are first asked for.

    Parameters
    ----------
    package : str
        Its ``__name__``.
    homes : mapping of str to str
        Module of each name, relative to the package.
    rooms : collection of str, optional
        Packages inside it, each imported when it is first asked for.

    Returns
    -------
    __getattr__, __dir__ : callable
    __all__ : list of str
    """

    def getattribute(name: str) -> Any:
        if name in rooms:
            return import_module(f".{name}", package)
        if name not in homes:
            module = sys.modules.get(package)
            message = f"module {package!r} has no attribute {name!r}"
            raise AttributeError(message, name=name, obj=module)
        return getattr(import_module(homes[name], package), name)

    def directory() -> list[str]:
        own = (name for name in vars(sys.modules[package]) if name.startswith("__"))
        return sorted({*homes, *rooms, *own})

    return getattribute, directory, sorted(homes)
