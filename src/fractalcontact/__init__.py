"""Contact, closure, dilatancy and size effect of rough cracks, from profilometer scans."""

from importlib import import_module

from .errors import InputError, NotConverged

#: Imported when first asked for: the reader process of a scan file needs no contact solver.
_HOMES = {
    "ContactState": ".contact",
    "solve_contact": ".contact",
    "HalfSpace": ".halfspace",
}

__all__ = ["ContactState", "HalfSpace", "InputError", "NotConverged", "solve_contact"]


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)
