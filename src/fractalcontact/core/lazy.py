"""Names of a room, imported when they are first asked for.

To read the workflow, or one scan file, neither xarray, numba nor matplotlib may be imported.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def exports(
    package: str, homes: Mapping[str, str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """What an ``__init__`` needs to import its names when they are first asked for.

    Parameters
    ----------
    package : str
        Its ``__name__``.
    homes : mapping of str to str
        Module of each name, relative to the package.

    Returns
    -------
    __getattr__, __dir__ : callable
    __all__ : list of str
    """

    def getattribute(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(import_module(homes[name], package), name)

    return getattribute, lambda: sorted(homes), sorted(homes)
