"""Contact, closure, dilatancy and size effect of rough cracks, from profilometer scans."""

from .core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "ContactState": ".contact.state",
        "HalfSpace": ".elastic.halfspace",
        "InputError": ".core.errors",
        "NotConverged": ".core.errors",
        "solve_contact": ".contact.solve",
    },
)
